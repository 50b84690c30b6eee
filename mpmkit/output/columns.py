"""The scalars and vectors of a history."""

from __future__ import annotations

from .variables import Variable

COLUMNS = (
    Variable("spread_diameter", "m", "spread diameter"),
    Variable("height", "m", "largest height"),
    Variable("axis_height", "m", "height on the axis"),
    Variable("slump", "m", "slump"),
    Variable("kinetic_energy", "J", "kinetic energy"),
    Variable("potential_energy", "J", "potential energy"),
    Variable("strain_energy", "J", "elastic energy"),
    Variable("compressive_energy", "J", "compressive energy"),
    Variable("total_mass", "kg", "total mass"),
    Variable("momentum", "kg m/s", "momentum", component=True),
    Variable("max_speed", "m/s", "largest speed"),
    Variable("fractured_fraction", "1", "part of the volume in boxes longer than a cell"),
    Variable("density_mean", "1", "nodal density over the material's, mean over the interior"),
    Variable(
        "density_worst", "1", "nodal density over the material's, at the interior node with the largest error"
    ),
    Variable("redistribution_energy", "J", "energy added by the redistribution"),
    Variable("time_step", "s", "time step"),
    Variable("mach_number", "1", "largest speed over the sound speed"),
)
"""Columns of every history; docs/cases.md defines each. The long names are labels of plots."""


def ledger_columns(causes: tuple[str, ...]) -> tuple[Variable, ...]:
    """The columns of the ledger; the sum of each over the causes is the present amount."""
    return (
        Variable("ledger_mass", "kg", "mass by cause", dimension="cause", labels=causes),
        Variable(
            "ledger_momentum", "N s", "momentum by cause", component=True, dimension="cause", labels=causes
        ),
        Variable(
            "ledger_energy", "J", "energy of motion and stored, by cause", dimension="cause", labels=causes
        ),
    )


def wall_columns(axes: tuple[str, ...]) -> tuple[Variable, ...]:
    """The columns of the walls; a torque is about the axes of 3-D, or about the one out of the plane."""
    about = axes if len(axes) == 3 else ("t" if axes[0] == "r" else "y",)
    return (
        Variable("wall_force", "N", "force of the wall on the material", component=True, of_walls=True),
        Variable("wall_torque", "N m", "torque of the wall about the origin", of_walls=True, about=about),
        Variable("wall_power", "W", "power that the wall gives to the material", of_walls=True),
    )
