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
"""Volume ratios between which a run is sound, and which a law must bear. At a Mach number of 0.1 that of a
fluid is within a hundredth of 1; no law here is meant for a solid that is a tenth, or ten times, as large as
it was."""


@dataclass(frozen=True)
class StateVariable:
    """A quantity that a law remembers at each particle, or a contact at each node.

    >>> state = {"structure": StateVariable("1", "flocculation λ", initial="initial_structure")}
    """

    unit: str
    description: str
    shape: tuple[int, ...] = ()
    """Of its value at one particle; empty for a number."""
    initial: Any = 0.0
    """Its value at the beginning: a number, an array of its shape, or the name of a parameter of the law (or
    of a property of it), so that a case can give it."""

    def at_start(self, law: Plugin | None = None) -> np.ndarray:
        """The value at the beginning, of its shape.

        Args:
            law: the law, or contact, that declares it; not needed where ``initial`` is no name.

        Raises:
            ValueError: there is no such value; the text says what is there and what is allowed.
        """
        if not isinstance(self.shape, tuple):
            raise ValueError(f"has the shape {self.shape!r}; it must be a tuple of whole numbers")
        named = isinstance(self.initial, str)
        if named and not hasattr(law, self.initial):
            raise ValueError(f"starts from '{self.initial}', which is no parameter of the law")
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
    """What a law is given of the particles that it governs. Tensors are 3 × 3 in every space.

    The components follow the axes of the grid; in two dimensions the third one is out of the plane
    (the hoop direction of an axisymmetric scene).
    """

    velocity_gradient: np.ndarray
    """``(n, 3, 3)``, L_ij = ∂v_i/∂x_j, 1/s."""
    volume_ratio: np.ndarray
    """``(n,)``, J, current over initial volume."""
    pressure: np.ndarray
    """``(n,)``, of the equation of state, positive in compression, Pa; zero for a law that has its own."""
    density: float
    """Initial density, kg/m³."""
    deformation_gradient: np.ndarray | None = None
    """``(n, 3, 3)``, F, if the law asks for it."""
    sound_speed: float | None = None
    """Sound speed of the equation of state, m/s; None for a law that has its own pressure."""


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
    """A full law: from the motion and its own state to the stress.

    The framework adds ``-p I`` of the equation of state, so that a law which uses one returns the extra
    stress alone; a law with ``uses_equation_of_state = False`` returns the whole Cauchy stress.
    Stress is tension-positive, in the order xx, yy, zz, yz, xz, xy of the tensor's axes 0, 1, 2.
    """

    uses_equation_of_state: ClassVar[bool] = True
    needs_deformation_gradient: ClassVar[bool] = False
    state: ClassVar[Mapping[str, StateVariable]] = {}
    passive: ClassVar[bool] = True
    """Whether it only stores energy and dissipates it. A law that does work of its own, as one that swells,
    says False, and the energy of a scene that has it is not guarded."""
    exact_form: ClassVar[str | None] = None
    """Of a regularised law: the name of the one with the same flow curve and an exact yield stress, for
    ``plan`` to offer."""

    @abstractmethod
    def update_stress(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], dt: float, stress: np.ndarray
    ) -> None:
        """Write the stress at the end of the step into ``stress``, ``(n, 6)``, Pa, and update ``state``.

        On entry ``stress`` holds what the law wrote last, in the axes of then; it is zero at the beginning.
        """

    def in_scene(self, density: float, sound_speed: float | None, scale: Scale) -> ConstitutiveLaw:
        """The law with its open choices made for a scene, once, at the start; as it is by default.

        A run uses what this returns: a law whose elastic modulus is not given chooses it here.

        Args:
            density: initial density, kg/m³.
            sound_speed: of the equation of state at the start, m/s; None for a law that has its own pressure.
            scale: how large the scene is, and what drives it.
        """
        return self

    def wave_speed(self, density: float, sound_speed: float | None) -> float:
        """Fastest wave of the unstrained material, m/s, for the acoustic limit of the time step."""
        if sound_speed is None:
            raise ValueError(f"law '{self.name}' has no equation of state and must override wave_speed")
        return sound_speed

    def present_wave_speed(self, kinematics: Kinematics, state: Mapping[str, np.ndarray]) -> float:
        """Fastest wave in the present state, m/s, against the moving material; that of the unstrained one by
        default.

        A solid that stiffens as it is strained says so here; its steps then shorten with it.
        """
        return self.wave_speed(kinematics.density, kinematics.sound_speed)

    def largest_viscosity(self, largest_shear_rate: float) -> float:
        """Largest viscosity, Pa s, between rest and a shear rate, for the viscous limit of the time step."""
        return 0.0

    def remarks(self, density: float, sound_speed: float | None) -> list[str]:
        """What a user should know of the law in this material: sentences for the log and for ``plan``."""
        return []

    def yield_point(self, state: Mapping[str, np.ndarray]) -> np.ndarray | float | None:
        """Shear stress √(s:s/2), Pa, beyond which the material flows, a number or ``(n,)``.

        None for a law without a yield stress. Frames and histories show by it what has yielded.
        """
        return None

    def warnings(self, density: float, sound_speed: float | None, scale: Scale, until: float) -> list[str]:
        """What should not be trusted of this material in a scene that runs for ``until`` s: sentences."""
        return []

    def strain_energy(
        self, kinematics: Kinematics, state: Mapping[str, np.ndarray], stress: np.ndarray
    ) -> np.ndarray | float:
        """Elastic energy of shape per initial volume, J/m³, ``(n,)``; zero for a viscous fluid."""
        return 0.0
