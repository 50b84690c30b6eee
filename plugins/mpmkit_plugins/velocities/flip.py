"""FLIP: particles take the change of the nodal velocity."""

from mpmkit.contracts import Operations, VelocityUpdate, hookimpl


class FLIP(VelocityUpdate):
    """v ← v + Δṽ: what the step changed at the nodes; no numerical viscosity, and noise stays."""

    name = "flip"
    api_version = 2
    citation = "Brackbill & Ruppel, J. Comput. Phys. 65 (1986) 314-343"

    def map_to_particles(self, ops: Operations, dt: float) -> None:
        ops.move_particles(dt, flip=1.0)


@hookimpl
def mpmkit_velocity_updates():
    return [FLIP]
