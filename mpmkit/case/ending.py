"""The end of a run: at a time, or earlier, at rest or when a variable of the history reaches a bound."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import ConfigDict, Discriminator, Field, Tag, model_validator

from ..contracts import quantity
from .base import Model


class Bounds(Model):
    """Bounds for a variable of the history that end the run."""

    at_least: float | None = quantity("unit of the variable", "the variable is this or more", default=None)
    at_most: float | None = quantity("unit of the variable", "the variable is this or less", default=None)

    @model_validator(mode="after")
    def _bounds_something(self) -> Bounds:
        if self.at_least is None and self.at_most is None:
            raise ValueError("it must have at_least, at_most or both")
        if None not in (self.at_least, self.at_most) and self.at_least > self.at_most:  # type: ignore[operator]
            raise ValueError(
                f"at_least is {self.at_least:g} and at_most is {self.at_most:g}; no value is between them"
            )
        return self

    def hold(self, value: float) -> bool:
        """Whether a value is within the bounds; NaN never is."""
        low = self.at_least is None or value >= self.at_least
        return low and (self.at_most is None or value <= self.at_most)

    @property
    def words(self) -> str:
        """Such as "at least 0.5"."""
        named = (("at least", self.at_least), ("at most", self.at_most))
        return " and ".join(f"{word} {bound:g}" for word, bound in named if bound is not None)


class Until(Model):
    """The run ends as soon as the material is at rest, a variable of the history is within its bounds, or the
    time ``at_most`` is reached. Each other key is the name of a variable of the history."""

    model_config = ConfigDict(extra="allow")
    __pydantic_extra__: dict[str, Bounds]

    at_most: float = quantity("s", "simulated time at which the run ends in any case", gt=0)
    rest: bool = Field(default=False, description="whether the run ends when the material is at rest")

    def __eq__(self, other: Any) -> bool:
        return super().__eq__(other) and self.variables == other.variables

    @property
    def variables(self) -> dict[str, Bounds]:
        """Bounds for variables of the history that end the run."""
        return self.__pydantic_extra__ or {}

    @property
    def conditions(self) -> list[str]:
        """The conditions that end the run before ``at_most``, in words."""
        rest = ["the material is at rest"] if self.rest else []
        return rest + [f"{name} is {bounds.words}" for name, bounds in self.variables.items()]


# Tags differ from all names of keys, so that the path of an error is clear.
AnyUntil = Annotated[
    Annotated[float, Field(gt=0), Tag("a-time")] | Annotated[Until, Tag("on-conditions")],
    Discriminator(lambda value: "on-conditions" if isinstance(value, dict | Until) else "a-time"),
]


def latest(until: Any) -> float:
    """The time, s, at which a run ends at the latest, from ``until`` as a model or as JSON."""
    if isinstance(until, dict):
        return float(until["at_most"])
    return until.at_most if isinstance(until, Until) else float(until)


def conditions(until: float | Until) -> list[str]:
    """The conditions that may end a run early, in words; empty if it ends at a time."""
    return until.conditions if isinstance(until, Until) else []


def ending(until: float | Until) -> str | None:
    """A sentence about the end of a run; None if it ends only at a time."""
    earlier = " or ".join(conditions(until))
    return f"the run ends when {earlier}, at the latest at t = {latest(until):g} s" if earlier else None
