"""A run from its case to its run directory: start, steps, records, checkpoints, and end."""
