"""Compiled loops over particles and nodes. Each file holds one mapping; none of them knows a scheme."""
