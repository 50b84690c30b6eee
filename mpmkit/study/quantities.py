"""The numbers of each member in a study's dataset, besides its histories."""

from __future__ import annotations

from ..output.columns import COLUMNS

FIGURES = {
    "t500": ("s", "time to a spread of 500 mm"),
    "t500_from_lift": ("s", "time from the start of the lift to a spread of 500 mm"),
    "final_spread": ("m", "spread diameter at the end"),
    "final_slump": ("m", "slump at the end"),
    "final_height": ("m", "largest height at the end"),
    "final_spread_rate": ("m/s", "rate at which the spread diameter grows at the end"),
    "at_rest_since": ("s", "time since which the material has been at rest"),
    "simulated_time": ("s", "simulated time"),
    "particles": ("1", "particles at the end"),
}
"""Results in a summary: unit and meaning."""
COSTS = {
    "wall_seconds": ("s", "wall time of the run"),
    "cpu_seconds": ("s", "CPU time of the run"),
    "steps": ("1", "steps"),
    "particle_steps": ("1", "particle-steps"),
    "memory_bytes": ("B", "memory, as estimated by plan"),
}
"""Costs of a member: unit and meaning."""
TAKEN = {"time", "fate", "sentence", *FIGURES, *COSTS, *(column.name for column in COLUMNS)}
"""Names that a dimension of a study must not have."""
