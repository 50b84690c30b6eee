"""Update stress last."""

from mpmkit.contracts import Operations, UpdateOrder, hookimpl


class USL(UpdateOrder):
    """Stress from the updated nodal velocities, at the end of the step.

    It dissipates a little, and divides by the mass of nearly empty nodes when it takes the gradient.
    Ferreira et al. exchange USF and USL in their text; this is Bardenhagen's definition.

    Its stable steps are shorter than those of the others. Its stress comes from the nodal velocity F V + dt
    a, with V the particles' and F <= 1 the filter of mapping to the nodes and back, and not from F (V + dt
    a). With kappa = dt K / rho at the highest mode, lambda² + (kappa - 1) lambda + kappa (F - 1) = 0, stable
    for kappa < 2 / (2 - F), where USF and MUSL have kappa F < 2: 0.57 of the viscous limit and √(4/7) of dx/c
    inside a body with two particles per axis (F = 1/4). At a free surface, nodes that are nearly empty are
    stiffer still, see ``LEAST_WIDTH`` in ``solver/scene.py``. Measured in the worst places of bodies,
    with FLIP and own pressure: 0.40 of dx/c and 0.20 of the viscous limit; with averaged volumes 0.5 to 0.7
    of dx/c.
    """

    name = "usl"
    api_version = 2
    citation = "Bardenhagen, J. Comput. Phys. 180 (2002) 383-403"
    acoustic_fraction = 0.4
    viscous_fraction = 0.2

    def cautions(self, case) -> list[str]:
        if case.scheme.shape.smooth:
            return []
        return [
            f"order 'usl' with shape '{case.scheme.shape.name}' takes strains from nodes that are nearly "
            "empty, and throws out particles when material flows from cell to cell; order 'usf' or 'musl', "
            "or shape 'cpgimp', does not"
        ]

    def step(self, ops: Operations, dt: float) -> None:
        ops.map_to_grid()
        ops.solve_momentum(dt)
        ops.map_to_particles(dt, velocity_gradient=True)
        ops.update_stress(dt)


@hookimpl
def mpmkit_update_orders():
    return [USL]
