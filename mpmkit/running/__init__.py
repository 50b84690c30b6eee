"""A run from its case to its run directory: start, steps, records, checkpoints, and how it may end."""
