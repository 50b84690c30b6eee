"""Modified update stress last."""

from mpmkit.contracts import Operations, UpdateOrder, hookimpl


class MUSL(UpdateOrder):
    """As USL, but with the stress of velocities that are mapped to the nodes again after the update.

    A nearly empty node then gets a particle's velocity, never a quotient of two small numbers.
    """

    name = "musl"
    api_version = 2
    citation = "Sulsky, Zhou & Schreyer, Comput. Phys. Commun. 87 (1995) 236-252"

    def step(self, ops: Operations, dt: float) -> None:
        ops.map_to_grid()
        ops.solve_momentum(dt)
        ops.map_to_particles(dt)
        ops.remap_velocity()
        ops.update_velocity_gradient()
        ops.update_stress(dt)


@hookimpl
def mpmkit_update_orders():
    return [MUSL]
