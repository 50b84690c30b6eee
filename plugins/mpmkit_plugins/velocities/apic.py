"""Affine particle-in-cell, with a damping that does not depend on the time step."""

import math

from mpmkit.contracts import Operations, VelocityUpdate, hookimpl, quantity


class APIC(VelocityUpdate):
    """Particles carry an affine velocity, v + C (x - x̄); v ← α (v + Δṽ) + (1 - α) ṽ with α = exp(-rate dt).

    C = Σ N v (x_node - x̄)ᵀ D⁻¹ is taken from the grid in every step and mapped back with the momentum, so
    that a linear velocity field is mapped to the particles and back without loss. The rest, mostly noise, is
    damped. APIC as published damps all of it in every step, so the damping grows as the step gets smaller.
    Here it decays at a rate: α = 0 is APIC as published, α = 1 has no damping.

    A particle alone in its cells limits the step: it expands and contracts with ω² = c² Σ 1/D over the axes.
    D is at least dx²/8, the value of a box of half a cell at a node; ω dt < 2 then requires c dt/dx < √(1/6)
    in three dimensions and √(1/4) in two.
    """

    name = "apic"
    api_version = 2
    citation = "Jiang, Schroeder & Teran, J. Comput. Phys. 338 (2017) 137-164, with a rate"
    affine = True
    acoustic_fraction = 0.4

    rate: float | None = quantity(
        "1/s",
        "decay of the part of the velocity that is not affine on the grid; default: a "
        "20th of the cells that the fastest wave crosses in a second",
        ge=0,
        default=None,
    )

    def map_to_particles(self, ops: Operations, dt: float) -> None:
        rate = 0.05 / ops.acoustic_time if self.rate is None else self.rate
        ops.move_particles(dt, flip=math.exp(-rate * dt), affine=True)


@hookimpl
def mpmkit_velocity_updates():
    return [APIC]
