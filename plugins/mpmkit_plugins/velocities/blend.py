"""A blend of FLIP and PIC whose damping does not depend on the time step."""

import math

from mpmkit.contracts import Operations, VelocityUpdate, hookimpl, quantity


class Blend(VelocityUpdate):
    """v ← α (v + Δṽ) + (1 - α) ṽ with α = exp(-rate dt).

    The usual blend fixes α a step, so that halving the step doubles the damping. With a rate, what the grid
    does not see of a particle's velocity decays as exp(-rate t) whatever the step.
    """

    name = "blend"
    api_version = 2
    citation = "Stomakhin et al., ACM Trans. Graph. 32 (2013) 102, with a rate instead of a fraction a step"

    rate: float = quantity(
        "1/s", "decay of the part of the velocity that the grid cannot represent", ge=0, default=10.0
    )

    def map_to_particles(self, ops: Operations, dt: float) -> None:
        ops.move_particles(dt, flip=math.exp(-self.rate * dt))


@hookimpl
def mpmkit_velocity_updates():
    return [Blend]
