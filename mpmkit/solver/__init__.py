"""The solver: particles and grid of a case, the operations of a step, and the loop."""
