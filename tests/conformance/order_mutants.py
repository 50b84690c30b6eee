"""A correct update order, and mutants of it with one fault each."""

from sound_laws import Sound

from mpmkit.contracts import UpdateOrder


class Modified(Sound, UpdateOrder):
    """Correct: MUSL."""

    def step(self, ops, dt):
        ops.map_to_grid()
        ops.solve_momentum(dt)
        ops.map_to_particles(dt)
        ops.remap_velocity()
        ops.update_velocity_gradient()
        ops.update_stress(dt)


class StressBackwards(Sound, UpdateOrder):
    def step(self, ops, dt):
        ops.map_to_grid()
        ops.solve_momentum(dt)
        ops.map_to_particles(dt, velocity_gradient=True)
        ops.update_stress(-dt)


class TwiceTheStrain(Sound, UpdateOrder):
    def step(self, ops, dt):
        ops.map_to_grid()
        ops.solve_momentum(dt)
        ops.map_to_particles(dt, velocity_gradient=True)
        ops.update_stress(2 * dt)


class NoForces(Sound, UpdateOrder):
    def step(self, ops, dt):
        ops.map_to_grid(forces=False)
        ops.solve_momentum(dt)
        ops.map_to_particles(dt, velocity_gradient=True)
        ops.update_stress(dt)


class ForcesTwice(Sound, UpdateOrder):
    def step(self, ops, dt):
        ops.map_to_grid()
        ops.map_forces()
        ops.solve_momentum(dt)
        ops.map_to_particles(dt, velocity_gradient=True)
        ops.update_stress(dt)


class NoMomentumEquation(Sound, UpdateOrder):
    def step(self, ops, dt):
        ops.map_to_grid()
        ops.map_to_particles(dt, velocity_gradient=True)
        ops.update_stress(dt)


class NeverStrains(Sound, UpdateOrder):
    def step(self, ops, dt):
        ops.map_to_grid()
        ops.solve_momentum(dt)
        ops.map_to_particles(dt)


class NeverMoves(Sound, UpdateOrder):
    def step(self, ops, dt):
        ops.map_to_grid()
        ops.solve_momentum(dt)
        ops.update_velocity_gradient()
        ops.update_stress(dt)
