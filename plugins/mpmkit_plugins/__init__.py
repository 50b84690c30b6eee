"""The built-in plug-ins: one concept, one file, each found by its own entry point like a third party's."""
