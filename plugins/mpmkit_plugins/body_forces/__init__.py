"""Body forces."""
