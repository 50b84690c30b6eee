"""The validation report: what the tests recorded, as tables and figures."""
