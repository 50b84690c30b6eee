"""The whole state of a simulation as arrays: written down after one step, it goes on to the same bits."""

from __future__ import annotations

import numpy as np

from ..kernels.scatter import CONTACT
from .simulation import Simulation
from .time_step import Limits

State = dict[str, np.ndarray]
"""Arrays by name; a number or a text is an array without axes."""


def state_of(simulation: Simulation) -> State:
    """What a simulation that has done a step depends on from here on, beside its case."""
    p, operations, sorting = simulation.particles, simulation.operations, simulation.operations.sorting
    numbers = {
        "time": simulation.time,
        "steps": simulation.steps,
        "particle_steps": simulation.particle_steps,
        "time_step": simulation.time_step,
        "limited_by": simulation.limited_by,
        "limits": list(simulation.limits.as_dict().values()),
        "mach_number": simulation.mach_number,
        "mean_speed": operations.mean_speed,
        "relaxation_due": operations.relaxation.due,
        "contacts": operations.window.nodes[:, CONTACT],
        "parts": [[group.part.start, group.part.stop] for group in p.groups],
        "sound_speeds": [np.nan if g.sound_speed is None else g.sound_speed for g in p.groups],
    }
    state = {name: np.array(value) for name, value in numbers.items()}
    state |= {f"sorting.{name}": value for name, value in sorting.state().items()}
    state |= {f"particles.{name}": value for name, value in p.arrays().items()}
    for index, group in enumerate(p.groups):
        state |= {f"law.{index}.{name}": value for name, value in group.state.items()}
    return state


def restore(simulation: Simulation, state: State) -> None:
    """Put a simulation that has just been made of the same case into a state.

    Raises:
        KeyError: the state lacks something.
    """
    p, operations = simulation.particles, simulation.operations
    for name in p.arrays():
        setattr(p, name, state[f"particles.{name}"].copy())
    for index, (group, part, speed) in enumerate(
        zip(p.groups, state["parts"], state["sound_speeds"], strict=True)
    ):
        group.part = slice(int(part[0]), int(part[1]))
        group.sound_speed = None if np.isnan(speed) else float(speed)
        group.state = {name: state[f"law.{index}.{name}"].copy() for name in group.state}
    operations.allocate()
    operations.sorting.restore({name: state[f"sorting.{name}"] for name in operations.sorting.state()})
    operations.window.nodes[:, CONTACT] = state["contacts"]
    operations.mean_speed = float(state["mean_speed"])
    operations.relaxation.due = float(state["relaxation_due"])
    simulation.time, simulation.steps = float(state["time"]), int(state["steps"])
    simulation.particle_steps = int(state["particle_steps"])
    simulation.time_step, simulation.limited_by = float(state["time_step"]), str(state["limited_by"])
    simulation.limits = Limits(*map(float, state["limits"]))
    operations.acoustic_time = simulation.limits.acoustic
    simulation.mach_number = float(state["mach_number"])
