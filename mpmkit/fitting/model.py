"""The fit: measurements, the cases that model them, and the parameters to find, as a pydantic model."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, WithJsonSchema, model_validator

from ..case.base import Model, name_of_directory


def _said(kind: str, allowed: str) -> WithJsonSchema:
    """The schema of a type, with the allowed values in words, which error messages use."""
    return WithJsonSchema({"type": kind, "allowed": allowed})


CaseOrFile = (
    Annotated[str, _said("string", "the path of a case file")]
    | Annotated[dict[str, Any], _said("object", "a case itself")]
)
Changes = Annotated[
    dict[str, Any],
    _said("object", 'an object of values by their paths in the case, such as {"grid.cell_size": 0.01}'),
]
"""New values by their paths in the case."""


NARROWEST = 1e-3
"""Least width of the bounds of a parameter, relative to its value."""
MOST_DECADES = 1e9
"""Largest ratio of the bounds on a logarithmic scale."""


class Columns(Model):
    """Names of the columns of a CSV file."""

    time: str = Field(default="time_s", description="column of the times, s")
    value: str | None = Field(
        default=None, description="column of the values; default: <variable>_<unit>, spread_diameter_m"
    )
    uncertainty: str | None = Field(default=None, description="column of the standard uncertainties")


class Measurement(Model):
    """A number with its uncertainty, or a curve over time from a CSV file."""

    variable: str = Field(
        description="a figure of the summary, such as final_spread or t500, or a variable of the history"
    )
    value: float | None = Field(default=None, description="the measured number, in SI units")
    file: str | None = Field(default=None, description="a CSV file with the measured curve")
    columns: Columns = Columns()
    uncertainty: float | None = Field(
        default=None, gt=0, description="standard uncertainty, in the unit of the value"
    )
    relative_uncertainty: float | None = Field(
        default=None, gt=0, lt=1, description="standard uncertainty as part of each value"
    )
    time: float | None = Field(
        default=None, ge=0, description="of a history: the time, s, at which the value was measured"
    )
    reaches: float | None = Field(
        default=None, description="of a history: the value is the time, s, at which it reaches this level"
    )
    of: dict[str, str] = Field(
        default={}, description='part of a history with more dimensions, {"wall": "bob", "component": "t"}'
    )
    first: float = Field(default=0.0, ge=0, description="of a curve: rows before this time, s, are left out")
    last: float | None = Field(
        default=None, gt=0, description="of a curve: rows after this time, s, are left out"
    )

    @model_validator(mode="after")
    def _is_one_thing(self) -> Measurement:
        if (self.value is None) == (self.file is None):
            given = "neither is given" if self.value is None else "both are given"
            raise ValueError(f"a measurement has either value or file, and {given}")
        if self.value is None and (self.time is not None or self.reaches is not None):
            raise ValueError("time and reaches belong to a value, and this measurement is a file")
        if self.time is not None and self.reaches is not None:
            raise ValueError("a measurement has either time or reaches, and both are given")
        stated = [self.uncertainty, self.relative_uncertainty, self.columns.uncertainty]
        if sum(entry is not None for entry in stated) != 1:
            raise ValueError(
                f"the measurement of {self.variable} must have one of uncertainty, relative_uncertainty "
                "and columns.uncertainty"
            )
        if self.file is None and self.columns.uncertainty is not None:
            raise ValueError("columns.uncertainty belongs to a file, and this measurement is a value")
        if self.last is not None and self.last <= self.first:
            raise ValueError(
                f"first is {self.first:g} s and last is {self.last:g} s; first must be below last"
            )
        return self


class Test(Model):
    """One laboratory test: the case that models it, and what was measured in it."""

    __test__ = False  # for pytest, which would collect it by its name

    case: CaseOrFile = Field(description="the model of the test: a case file, or the case itself")
    changes: Changes = Field(default={}, description="values by path that replace those of its case")
    measurements: list[Measurement] = Field(min_length=1)
    stages: list[Changes] | None = Field(
        default=None,
        description="changes of the case in each stage, from the coarsest model to the finest; "
        "default: the coarser cells that plan proposes, and then the case itself",
        min_length=1,
    )
    model_error: float | None = Field(
        default=None, ge=0, lt=1, description="error of the finest model, as part of each value"
    )


class Prior(Model):
    """Prior knowledge of a parameter: a normal distribution along its scale."""

    value: float
    deviation: float = Field(gt=0, description="standard deviation, in the unit of the parameter")


class Parameter(Model):
    """A number of the case that the fit determines."""

    low: float = Field(description="least value tried")
    high: float = Field(description="largest value tried")
    scale: Literal["log", "linear"] = "log"
    start: float | None = Field(default=None, description="first guess; default: a closed form or the middle")
    prior: Prior | None = None

    @model_validator(mode="after")
    def _in_order(self) -> Parameter:
        if not self.low < self.high:
            raise ValueError(
                f"low is {self.low:g} and high is {self.high:g}; low must be below high, so exchange them"
                if self.low > self.high
                else f"low and high are both {self.low:g}; low must be below high"
            )
        if self.scale == "log" and self.low <= 0:
            raise ValueError(
                f"low is {self.low:g}; on a logarithmic scale it must be above 0, or give scale 'linear'"
            )
        widest, least = self.high - self.low, NARROWEST * max(abs(self.low), abs(self.high))
        if widest < least:
            raise ValueError(
                f"low is {self.low:.9g} and high is {self.high:.9g}; they must differ by at least "
                f"{NARROWEST:g} of the value"
            )
        if self.scale == "log" and self.high / self.low > MOST_DECADES:
            raise ValueError(
                f"low is {self.low:g} and high is {self.high:g}; high must be at most "
                f"{MOST_DECADES:g} times low"
            )
        if self.start is not None and not self.low <= self.start <= self.high:
            raise ValueError(f"start is {self.start:g}; it must be from {self.low:g} to {self.high:g}")
        if self.prior is not None and not self.low <= self.prior.value <= self.high:
            raise ValueError(
                f"prior.value is {self.prior.value:g}; it must be from {self.low:g} to {self.high:g}"
            )
        return self


class Alternative(Model):
    """Another law, or another model, that is fitted to the same measurements."""

    changes: Changes = Field(default={}, description="values by path that replace those of the cases")
    parameters: dict[str, Parameter] = Field(min_length=1, description="the parameters to find, by path")


class Budget(Model):
    """Limits of the effort; the fit returns what it has found by then."""

    runs: int = Field(default=400, ge=1, description="new runs")
    minutes: float | None = Field(default=None, gt=0, description="wall time; default: no limit")


class Fit(Model):
    """Measurements, the cases that model them, and the parameters to find."""

    name: str = name_of_directory("fit", "name of its directory")
    description: str = ""
    tests: dict[str, Test] = Field(min_length=1, description="the tests of the material, by name")
    parameters: dict[str, Parameter] = Field(
        min_length=1, description="parameters to find, by path in the cases"
    )
    laws: dict[str, Alternative] = Field(
        default={}, description="other laws to fit to the same measurements, by a name of your own"
    )
    level: float = Field(default=0.9, gt=0, lt=1, description="confidence level of the intervals")
    budget: Budget = Budget()
    threads: int = Field(default=1, ge=1, description="threads of each run")
    pages: bool = Field(default=True, description="whether each run keeps a page, of at most 1 MB")
