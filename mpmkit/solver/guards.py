"""Guards stop a run that has gone wrong; the message gives step, particle, likely cause and cure."""

from __future__ import annotations

from typing import NoReturn

import numpy as np

from ..case.plugins import plugins_of
from ..contracts.law import LEAST_RATIO, MOST_RATIO
from ..errors import GuardStop, PluginFault
from ..kernels.compile import CHUNK
from ..kernels.locate import first_unsound
from ..registry import audit
from ..registry.audit import require_sentences
from ..registry.blame import blaming_plugins
from .balance import EnergyBalance
from .density import Density
from .density_watch import DensityWatch, cure
from .ledger import ENERGY
from .stateful import State, Stateful, plain_state, restore, restore_plain, state_of
from .time_step import warnings
from .view import SceneView

COLLAPSED = 1e-4
"""If the step falls below this part of the longest step so far, a run of a minute would take a week."""
DRIFT = 1e-9
"""Largest relative error of the mass; rounding is a thousand times smaller."""


class Guards:
    """Checks a scene every few steps, and stops the run if its results can no longer be right.

    Attributes:
        watches_energy: set it to False if something does work that the ledger does not know, such as forces
        that a program adds to the nodes. A law that adds energy declares it itself (``passive``).
        watches_density: set it to False to follow a flow beyond the point at which its density is wrong.
        density: the monitor of the density of the interior.
    """

    def __init__(self, scene: SceneView) -> None:
        self._scene = scene
        self._begun = False
        self._longest_step = 0.0
        self.watches_energy = all(group.law.passive for group in scene.particles.groups)
        self.balance: EnergyBalance | None = None
        self.watches_density = True
        self.density = DensityWatch()

    @property
    def components(self) -> dict[str, Stateful]:
        """The components with a state."""
        found: dict[str, Stateful] = {"density": self.density}
        return found if self.balance is None else found | {"balance": self.balance}

    def state(self) -> State:
        """The memory of the guards; without it, a resumed run would start with clean guards."""
        return plain_state(self, but=("balance",)) | state_of(self.components)

    def restore(self, state: State) -> None:
        """Restore the memory; the particles must be restored before."""
        self.balance = self._new_balance() if any(name.startswith("balance/") for name in state) else None
        restore(self.components, state)
        restore_plain(self, state)

    def begin(self) -> None:
        """Record the energy of the initial state, at the first call."""
        if self._begun:
            return
        self._begun = True
        if self.watches_energy:
            self.balance = self._new_balance()

    def _new_balance(self) -> EnergyBalance:
        s = self._scene
        strength = float(np.linalg.norm(s.case.gravity_vector)) + float(np.linalg.norm(s.case.largest_forces))
        return EnergyBalance(s.particles, s.grid, strength)

    def check(self) -> None:
        """Raise GuardStop if the results of the run can no longer be right.

        That is: a particle is unsound, mass is missing, energy was created, or positions and volumes of the
        particles contradict each other.

        Raises:
            PluginFault: mass got lost because a shape function's weights do not sum to one.
        """
        p = self._scene.particles
        firsts = np.empty(len(p) // CHUNK + 1, dtype=np.int64)
        state = p.position, p.velocity, p.stress, p.pressure, p.volume_ratio
        unsound = first_unsound(*state, LEAST_RATIO, MOST_RATIO, firsts)
        if unsound >= 0:
            stop(self._scene, int(unsound))
        self._check_mass()
        if self.balance is not None:
            self.balance.update(p, self._scene.account()[:, ENERGY])
            if self.watches_energy and self.balance.broken:
                self._stop_of_energy(self.balance)
        uneven = self.density.look(self._scene)
        if uneven is not None and self.watches_density:
            self._stop_of_density(uneven)

    def check_step(self) -> None:
        """Raise GuardStop if the step is not a positive number, or has become extremely short."""
        s = self._scene
        step = s.time_step
        if not step > COLLAPSED * self._longest_step or not s.time + step > s.time:
            fastest = _fastest(s)
            speed = float(np.linalg.norm(s.particles.velocity[fastest]))
            was = f", from {self._longest_step:.3g} s at its longest" if self._longest_step else ""
            what = f"is the fastest, {speed:.4g} m/s, and the step has fallen to {step:.3g} s{was}"
            why = f"the {s.limited_by} limit sets it; {remedy(s)}"
            if s.limited_by == "viscous":
                why = "the viscous limit sets it: bound the law's viscosity, or take a relaxed or exact form"
            raise _stopped(s, "step-collapse", fastest, what, why)
        self._longest_step = max(self._longest_step, step)

    def _check_mass(self) -> None:
        s, p = self._scene, self._scene.particles
        mass, expected = float(np.sum(p.mass)), s.ledger.mass
        if not abs(mass - expected) <= DRIFT * expected:
            off, found = np.zeros(len(p)), f"and the particles have a mass of {mass:.9g} kg"
            for group in p.groups:
                off[group.part] = np.abs(
                    p.mass[group.part] / (group.density * p.initial_volume[group.part]) - 1
                )
            worst = int(np.argmax(off))
            what = f"has {p.mass[worst]:.4g} kg, {found}, but they should have {expected:.9g} kg"
            raise _stopped(
                s,
                "mass-drift",
                worst,
                what,
                "a plug-in may have changed their masses; try it with --no-plugins",
            )
        mapped = s.mapped_mass
        if mapped is not None and not abs(mapped - mass) <= DRIFT * mass:
            worst = self._require_weights()
            what = f"and the others have {mass:.9g} kg, but the nodes have {mapped:.9g} kg"
            order = f"order '{s.case.scheme.order.name}' may not map all mass; try another one"
            raise _stopped(s, "mass-drift", worst, what, order)

    def _require_weights(self) -> int:
        """The particle whose sum of weights is farthest from one; PluginFault if by more than rounding."""
        s = self._scene
        total = s.sum_of_weights()
        worst = int(np.argmax(np.abs(total - 1)))
        if not abs(total[worst] - 1) <= DRIFT:
            number = int(s.particles.number[worst])
            what = f"gave particle {number} weights that sum to {total[worst]:.9g} and not to 1"
            raise PluginFault(s.case.scheme.shape, what, particle=number)
        return worst

    def _stop_of_energy(self, balance: EnergyBalance) -> NoReturn:
        s = self._scene
        fastest = _fastest(s)
        speed = float(np.linalg.norm(s.particles.velocity[fastest]))
        what = (
            f"is the fastest, {speed:.4g} m/s, and {balance.created:.4g} J of energy were created: motion "
            f"and stored energy are {balance.held:.4g} J, but only {balance.supply:.4g} J were available"
        )
        why = remedy(s)
        if balance.redistributed > balance.created / 2:
            name = s.case.scheme.redistribution.name
            put_in = f"redistribution '{name}' has added {balance.redistributed:.4g} J"
            why = f"{put_in}: try another one, or 'none'"
        raise _stopped(s, "energy", fastest, what, why)

    def _stop_of_density(self, found: Density) -> NoReturn:
        s = self._scene
        away = np.linalg.norm(s.particles.position - found.place, axis=1)
        what = (
            f"is where the density is worst, {found.worst:.3g} times the right one: inside the material the "
            f"density is wrong by {100 * found.departure:.2g} % on average, so flow, volume and height are "
            "wrong"
        )
        why = f"positions and volumes of the particles contradict each other; {cure(s)}"
        raise _stopped(s, "density", int(np.nanargmin(away)), what, why)


def stop(s: SceneView, index: int, scattered: bool = False, drawn_out: bool = False) -> NoReturn:
    """Raise the GuardStop for the fault of a particle.

    Raises:
        PluginFault: wrong weights of a shape function caused the fault.
    """
    s.require_tables()
    p, axes = s.particles, s.grid.axes
    position = p.position[index] + s.grid.lower
    state = np.concatenate([position, p.velocity[index], p.stress[index], p.pressure[index : index + 1]])
    ratio, sides = p.volume_ratio[index], 2 * p.half_size[index]
    why = remedy(s)
    if not np.isfinite(state).all():
        guard, what = "non-finite", "has a position, velocity or stress that is not finite"
    elif not LEAST_RATIO <= ratio <= MOST_RATIO:
        guard, what = (
            "volume-ratio",
            f"has a volume ratio of {ratio:.3g}, outside {LEAST_RATIO:g} to {MOST_RATIO:g}",
        )
        if ratio <= 0:
            what = f"has a volume ratio of {ratio:.3g}, which is not positive"
    elif not (sides > 0).all() or not np.isfinite(sides).all():
        guard = "particle-domain"
        what = f"has a domain with sides of {', '.join(f'{side:.3g}' for side in sides)} m"
    elif drawn_out:
        guard, what = "splitting", "and others are drawn out so far that their halves do not fit into memory"
    elif scattered:
        guard = "scattered"
        what = "is so far from the others that the nodes between them do not fit into memory"
    else:
        guard = "particle-outside"
        where = ", ".join(f"{axis} = {x:.4g}" for axis, x in zip(axes, position, strict=True))
        what, open_ = f"left the grid at {where} m", _open_faces(s, position)
        if open_:
            faces = " and ".join(open_)
            why = f"enlarge grid.domain or close that face, {faces}; if the particle was thrown out: {why}"
        else:
            what += ", through a face that is closed"
    raise _stopped(s, guard, index, what, why)


def remedy(s: SceneView) -> str:
    """The most likely cause of a diverging run, and a cure."""
    scheme = s.case.scheme
    exceeded = warnings(scheme, s.limits, s.time_step)
    if exceeded:
        return f"probably because {exceeded[0]}: remove that limit from it"
    for plugin in (scheme.order, scheme.shape, scheme.velocity, scheme.volumetric, scheme.redistribution):
        for caution in require_sentences(plugin, "cautions", plugin.cautions(s.case)):
            return f"probably because {caution}"
    step = f"reduce scheme.time_step.fraction, which is {scheme.time_step.fraction:g}"
    torn = _torn(s)
    if torn > 0:
        cure = "smaller cells" if scheme.splitting else "smaller cells or scheme.splitting"
        return (
            f"the material is torn: {100 * torn:.2g} % of its volume is in boxes longer than a cell; a "
            f"shorter step does not cure this, but {cure} may; if the run lasts longer with a shorter step, "
            f"{step}"
        )
    return f"probably the step is too long: {step}; if half of it stops at the same time, it is not the cause"


def _torn(s: SceneView) -> float:
    """Part of the volume in boxes that are longer than a cell along an axis."""
    p = s.particles
    volume = np.where(np.isfinite(p.volume), p.volume, 0.0)
    drawn_out = (2 * p.box > s.grid.cell_size * (1 + 1e-9)).any(axis=1)
    return float(volume[drawn_out].sum() / volume.sum()) if drawn_out.any() else 0.0


def _open_faces(s: SceneView, position: np.ndarray) -> list[str]:
    """The open faces beyond which a position lies."""
    faces = s.case.grid.faces
    lower, upper = s.case.domain_bounds
    beyond = [
        f"{axis}_{side}"
        for a, axis in enumerate(s.grid.axes)
        for side, out in (("min", position[a] < lower[a]), ("max", position[a] > upper[a]))
        if out
    ]
    return [name for name in beyond if faces.get(name, "open") == "open" and name != "r_min"]


def _fastest(s: SceneView) -> int:
    return int(np.argmax(np.einsum("pi,pi->p", s.particles.velocity, s.particles.velocity)))


def _stopped(s: SceneView, guard: str, index: int, what: str, why: str) -> GuardStop:
    number = int(s.particles.number[index])
    who = f"particle {number}{_at_walls(s, s.particles.position[index] + s.grid.lower)}"
    sentence = f"stopped at step {s.steps}, t = {s.time:.6g} s: {who} {what}; {why}"
    return GuardStop(guard, sentence, step=s.steps, particle=number)


def _at_walls(s: SceneView, place: np.ndarray) -> str:
    """The walls within a cell of a position, m, in words that follow the name of a particle."""
    if not np.isfinite(place).all():
        return ""
    with blaming_plugins(plugins_of(s.case)):
        surfaces = {name: audit.placed(wall.surface, s.case.space_) for name, wall in s.case.walls.items()}
        near = [
            f"walls.{name}"
            for name, surface in surfaces.items()
            if surface.present(s.time)
            and abs(surface.distance(place[None], s.time)[0][0]) <= s.grid.cell_size
        ]
    return f", at {' and '.join(near)}," if near else ""
