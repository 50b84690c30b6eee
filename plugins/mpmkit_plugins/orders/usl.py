"""Update stress last."""

from mpmkit.contracts import Operations, UpdateOrder, hookimpl


class USL(UpdateOrder):
    """Stress from the updated nodal velocities, at the end of the step.

    It dissipates a little, and divides by the mass of nearly empty nodes when it takes the gradient.
    The sentence of Ferreira et al. on USF and USL has the two confused; this is Bardenhagen's.

    With FLIP its viscous limit is lower than that of the others. Its stress comes from the nodal velocity
    F V + dt a, with V the particles' and F <= 1 the filter of mapping to the nodes and back, and not from
    F (V + dt a). With kappa = dt K / rho at the highest mode, lambda² + (kappa - 1) lambda +
    kappa (F - 1) = 0, stable for kappa < 2 / (2 - F), where USF and MUSL have kappa F < 2. One particle in
    the middle of a cell has F = 0: half of the limit; two have F = 1/4, 0.57 of it. For the same reason it
    bears √(4/7) = 0.756 of dx/c with two particles, where USF and MUSL bear all of it.
    """

    name = "usl"
    api_version = 1
    citation = "Bardenhagen, J. Comput. Phys. 180 (2002) 383-403"
    acoustic_fraction = 0.75
    viscous_fraction = 0.5

    def step(self, ops: Operations, dt: float) -> None:
        ops.map_to_grid()
        ops.solve_momentum(dt)
        ops.update_velocity_gradient()
        ops.map_to_particles(dt)
        ops.update_stress(dt)


@hookimpl
def mpmkit_update_orders():
    return [USL]
