"""A law under test, and what its author says of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ..contracts import (
    ConstitutiveLaw,
    ElastoviscoplasticLaw,
    ElastoviscoplasticLawWithState,
    GeneralisedNewtonianLaw,
)
from .specimens import DENSITY, SOUND_SPEED, Specimens, random_gradients, simple_shear

Curve = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True)
class LawSubject:
    """A law with parameters, and what to expect of it; see ``law_tests``."""

    law: ConstitutiveLaw
    flow_curve: Curve | None = None
    strain: float = 2.0
    rel: float | None = None
    density: float = DENSITY
    sound_speed: float = SOUND_SPEED

    kind = "law"

    @property
    def plugin(self) -> ConstitutiveLaw:
        return self.law

    @property
    def curve(self) -> Curve | None:
        """The given flow curve, or the one that the law is made of."""
        law = self.law
        if self.flow_curve is not None:
            return self.flow_curve
        if isinstance(law, ElastoviscoplasticLawWithState):
            return None  # in steady shear its state is another one than at the start
        if isinstance(law, ElastoviscoplasticLaw):
            return law.flow_curve
        if isinstance(law, GeneralisedNewtonianLaw):
            return lambda rate: law.apparent_viscosity(rate) * rate
        return None

    @property
    def hyperelastic(self) -> bool:
        """Whether the whole stress is a function of F."""
        law = self.law
        return law.needs_deformation_gradient and not law.state and not law.uses_equation_of_state

    @cached_property
    def remembers(self) -> bool:
        """Whether the stress depends on what the law wrote last."""
        after = self.specimens(20)
        after.voigt[:] = np.random.default_rng(4).standard_normal((20, 6))
        L = random_gradients(20)
        return not np.array_equal(after.drive(L, 1e-6), self.respond(L, 1e-6, 1))

    @property
    def given_sound_speed(self) -> float | None:
        """What the framework tells the law; None if it has a pressure of its own."""
        return self.sound_speed if self.law.uses_equation_of_state else None

    def wave_speed(self) -> float:
        """What the law says, m/s."""
        return self.law.wave_speed(self.density, self.given_sound_speed)

    def specimens(self, n: int) -> Specimens:
        """Particles that have not moved yet."""
        return Specimens(self.law, n, self.density, self.sound_speed)

    def respond(self, L: np.ndarray, duration: float = 0.1, steps: int = 10) -> np.ndarray:
        """Stress, Pa, ``(n, 3, 3)``, of fresh particles after so many seconds at velocity gradients L."""
        return self.specimens(len(L)).drive(L, duration, steps)

    def scale(self) -> float:
        """Largest stress component in shear at 1 /s, Pa, that errors are measured against."""
        return float(np.abs(self.respond(simple_shear(np.array([1.0])))).max())
