"""Update stress first."""

from mpmkit.contracts import Operations, UpdateOrder, hookimpl


class USF(UpdateOrder):
    """Stress from the velocities just mapped to the nodes, before the momentum equation.

    It conserves energy best on average and may let it grow a little.
    """

    name = "usf"
    api_version = 2
    citation = "Bardenhagen, J. Comput. Phys. 180 (2002) 383-403"

    def step(self, ops: Operations, dt: float) -> None:
        ops.map_to_grid(forces=False)
        ops.update_velocity_gradient()
        ops.update_stress(dt)
        ops.map_forces()
        ops.solve_momentum(dt)
        ops.map_to_particles(dt)


@hookimpl
def mpmkit_update_orders():
    return [USF]
