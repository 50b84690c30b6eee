"""Contract of a constitutive law, at its full length."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from ..errors import PluginFault
from .base import Plugin
from .scale import Scale

LEAST_RATIO, MOST_RATIO = 0.1, 10.0
"""Volume ratios between which a run is sound, and for which a law must work. In a fluid at Mach 0.1 the ratio
is within 1 % of 1."""


@dataclass(frozen=True)
class StateVariable:
    """A quantity that a law remembers at each particle, or a contact at each node.

    >>> state = {"structure": StateVariable("1", "flocculation λ", initial="initial_structure")}
    """

    unit: str
    description: str
    shape: tuple[int, ...] = ()
    """Shape of the value at one particle; empty for a number."""
    initial: Any = 0.0
    """Value at the start: a number, an array of its shape, or the name of a parameter or property of the
    law, so that a case can give it."""

    def at_start(self, law: Plugin | None = None) -> np.ndarray:
        """The value at the start, with its shape.

        Args:
            law: the law or contact that declares it; not needed if ``initial`` is not a name.

        Raises:
            ValueError: there is no such value; the text says what is there and what is allowed.
        """
        if not isinstance(self.shape, tuple):
            raise ValueError(f"has the shape {self.shape!r}; it must be a tuple of whole numbers")
        named = isinstance(self.initial, str)
        if named and not hasattr(law, self.initial):
            raise ValueError(f"starts from '{self.initial}', which is not a parameter of the law")
        value = getattr(law, self.initial) if named else self.initial
        try:
            array = np.broadcast_to(np.asarray(value, dtype=float), self.shape)
        except (TypeError, ValueError):
            array = np.array(np.nan)
        if not np.isfinite(array).all():
            allowed = "a finite number" + (f" or an array of shape {self.shape}" if self.shape else "")
            source = f"its '{self.initial}', which is {value!r}" if named else repr(value)
            raise ValueError(f"starts from {source}; it must be {allowed}")
        return array


@dataclass(frozen=True)
class Kinematics:
    """The motion of the particles of a law. Tensors are 3 × 3 in every space.

    The components follow the axes of the grid; in two dimensions the third one is out of the plane
    (the hoop direction of an axisymmetric scene).
    """

    velocity_gradient: np.ndarray
    """``(n, 3, 3)``, L_ij = ∂v_i/∂x_j, 1/s."""
    volume_ratio: np.ndarray
    """``(n,)``, J, current over initial volume."""
    pressure: np.ndarray
    """``(n,)``, of the equation of state, positive in compression, Pa; zero for a law with its own."""
    density: float
    """Initial density, kg/m³."""
    deformation_gradient: np.ndarray | None = None
    """``(n, 3, 3)``, F, if the law asks for it."""
    sound_speed: float | None = None
    """Sound speed of the equation of state, m/s; None for a law that computes its own pressure."""
    age: np.ndarray | None = None
    """``(n,)``, time since the material came in through a source, or since the start, s, if the law asks for
    it."""
    time: float = 0.0
    """Time at the start of the step, s."""


def initial_state(law: ConstitutiveLaw, count: int) -> dict[str, np.ndarray]:
    """The state variables of so many particles at the beginning, each ``(count, *shape)``.

    Raises:
        PluginFault: one of them has no value there.
    """
    state = {}
    for name, variable in law.state.items():
        if not isinstance(variable, StateVariable):
            raise PluginFault(law, f"has a state '{name}' that is {variable!r}; it must be a StateVariable")
        try:
            start = variable.at_start(law)
        except ValueError as error:
            raise PluginFault(law, f"has a state '{name}' that {error}") from None
        state[name] = np.full((count, *variable.shape), start)
    return state


class ConstitutiveLaw(Plugin):
    """A full law: it computes the stress from the motion and from its own state.

    The framework adds ``-p I`` of the equation of state, so that a law which uses one returns the extra
    stress alone; a law with ``uses_equation_of_state = False`` returns the whole Cauchy stress.
    Stress is tension-positive, in the order xx, yy, zz, yz, xz, xy of the tensor's axes 0, 1, 2.
    """

    uses_equation_of_state: ClassVar[bool] = True
    needs_deformation_gradient: ClassVar[bool] = False
    needs_age: ClassVar[bool] = False
    """Whether ``kinematics.age`` is given to it, as for a material that sets."""
    state: ClassVar[Mapping[str, StateVariable]] = {}
    passive: ClassVar[bool] = True
    """Whether it only stores and dissipates energy. False for a law that does work, such as one that swells;
    the energy guard is then off."""
    exact_form: ClassVar[str | None] = None
    """For a regularised law: name of the law with the same flow curve and an exact yield stress, which
    ``plan`` offers."""

    @abstractmethod
    def update_stress(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], dt: float, stress: np.ndarray
    ) -> None:
        """Write the stress at the end of the step into ``stress``, ``(n, 6)``, Pa, and update ``state``.

        On entry ``stress`` has the values of the last step, in the axes of that step; zero at the start.
        """

    def in_scene(self, density: float, sound_speed: float | None, scale: Scale) -> ConstitutiveLaw:
        """The law that the run uses, with its open parameters chosen for the scene; default: the law itself.

        Called once, at the start. A law chooses an elastic modulus here that the case does not give.

        Args:
            density: initial density, kg/m³.
            sound_speed: of the equation of state at the start, m/s; None for a law with its own pressure.
            scale: energy, length and rate of the scene.
        """
        return self

    def wave_speed(self, density: float, sound_speed: float | None) -> float:
        """Fastest wave of the unstrained material, m/s, for the acoustic limit of the time step."""
        if sound_speed is None:
            raise ValueError(f"law '{self.name}' has no equation of state and must override wave_speed")
        return sound_speed

    def present_wave_speed(self, kinematics: Kinematics, state: Mapping[str, np.ndarray]) -> float:
        """Fastest wave in the present state, m/s, relative to the material; default: that of the unstrained
        state.

        A solid whose stiffness grows with strain overrides it; the time step is shortened accordingly.
        """
        return self.wave_speed(kinematics.density, kinematics.sound_speed)

    def largest_viscosity(self, largest_shear_rate: float) -> float:
        """Largest viscosity, Pa s, between rest and a shear rate, for the viscous limit of the time step."""
        return 0.0

    def remarks(self, density: float, sound_speed: float | None) -> list[str]:
        """Sentences for the log and for ``plan`` on the law in this material."""
        return []

    def yield_point(self, state: Mapping[str, np.ndarray]) -> np.ndarray | float | None:
        """Shear stress √(s:s/2), Pa, beyond which the material flows, a number or ``(n,)``.

        None for a law without a yield stress. Frames and histories use it for ``yielded``.
        """
        return None

    def warnings(self, density: float, sound_speed: float | None, scale: Scale, until: float) -> list[str]:
        """Sentences on results of this material that are not reliable in a run of ``until`` s."""
        return []

    def strain_energy(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], stress: np.ndarray
    ) -> np.ndarray | float:
        """Elastic energy of shape per initial volume, J/m³, ``(n,)``; zero for a viscous fluid."""
        return 0.0
