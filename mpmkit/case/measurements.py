"""The measurements of a case: what an apparatus reports, as formulas of the scene.

    "measurements": {
      "h1": {"formula": "depth(0)", "unit": "m", "description": "depth at the back wall"},
      "h2": {"formula": "depth(0.8)", "unit": "m", "description": "depth at the end wall"},
      "passing_ratio": {"formula": "h2 / h1", "unit": "1", "description": "h2/h1 of EN 12350-10"}
    }

Each is a variable of the history, and its last value is in the summary. A formula may use the scalars of the
history, the time, measurements above it, and functions that look at the scene.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

from pydantic import Field

from .base import Model
from .formula import FUNCTIONS, NoNumber, evaluate, functions_in, names_in, parse

SELF = "measurements"
NAMES = (
    "time",
    "spread_diameter",
    "height",
    "axis_height",
    "slump",
    "kinetic_energy",
    "potential_energy",
    "strain_energy",
    "compressive_energy",
    "total_mass",
    "max_speed",
)
"""Scalars of the history that a formula may use, with the time."""


TAKEN = (
    "momentum",
    "fractured_fraction",
    "density_mean",
    "density_worst",
    "redistribution_energy",
    "time_step",
    "mach_number",
    "wall_force",
    "wall_torque",
    "wall_power",
    "mass_out",
    "sink_mass",
    "sink_rate",
    "sink",
    "wall",
    "component",
    "about",
    "particle",
    "tensor_component",
    "stopped_because",
    "plugins",
    "units",
)
"""Other names of the history and the summary, which a measurement must not have."""


class Measurement(Model):
    """A number that is computed for every row of the history."""

    formula: str = Field(
        description="arithmetic over variables of the history, measurements above it, depth(x), surface(x), "
        "width(x), front(), force('wall', 'z'), torque('wall'), outflow('sink')"
    )
    unit: str = Field(description="its unit; 1 for a plain number")
    description: str = Field(description="what it is; the label of its plots")


Functions = Mapping[str, Callable[..., float]]


LOOKS = ("depth", "surface", "width", "front", "force", "torque", "outflow")
"""Functions that look at the scene."""
MEANS = ("force", "torque", "outflow")
"""Those that are means since the last row of the history, so that they have no value between rows."""


def functions(looks: object) -> Functions:
    """The functions of measurements: those of arithmetic, and ``LOOKS``, which are methods of ``looks``."""
    return FUNCTIONS | {name: getattr(looks, name) for name in LOOKS}


def means(measurements: Mapping[str, Measurement]) -> set[str]:
    """The measurements that use a mean since the last row, themselves or through one above them."""
    found: set[str] = set()
    for name, measurement in measurements.items():
        formula = parse(measurement.formula)
        if functions_in(formula) & {*MEANS} or names_in(formula) & found:
            found.add(name)
    return found


def measured(
    measurements: Mapping[str, Measurement], names: Mapping[str, float], looks: Functions
) -> dict[str, float]:
    """The value of each measurement, in its unit; NaN if it has no value at present, such as 0/0.

    Raises:
        ValueError: a formula is not valid; the message names the measurement.
    """
    found: dict[str, float] = {}
    for name, measurement in measurements.items():
        try:
            found[name] = evaluate(parse(measurement.formula), {**names, **found}, looks)
        except NoNumber:
            found[name] = math.nan
        except ValueError as error:
            raise ValueError(f"{SELF}.{name}.formula is '{measurement.formula}': {error}") from None
    return found
