"""Update stress last."""

from mpmkit.contracts import Operations, UpdateOrder, hookimpl


class USL(UpdateOrder):
    """Stress from the updated nodal velocities, at the end of the step.

    It dissipates a little, and divides by the mass of nearly empty nodes when it takes the gradient.
    The sentence of Ferreira et al. on USF and USL has the two confused; this is Bardenhagen's.
    """

    name = "usl"
    citation = "Bardenhagen, J. Comput. Phys. 180 (2002) 383-403"

    def step(self, ops: Operations, dt: float) -> None:
        ops.map_to_grid()
        ops.solve_momentum(dt)
        ops.update_velocity_gradient()
        ops.map_to_particles(dt)
        ops.update_stress(dt)


@hookimpl
def mpmkit_update_orders():
    return [USL]
