"""A correct velocity update, and mutants of it with one fault each."""

from sound_laws import Sound

from mpmkit.contracts import VelocityUpdate


class Undamped(Sound, VelocityUpdate):
    """Correct: FLIP."""

    def map_to_particles(self, ops, dt):
        ops.move_particles(dt, flip=1.0)


class Amplified(Sound, VelocityUpdate):
    """Fault: the part of the velocity that the grid cannot represent grows by a fifth in each step."""

    def map_to_particles(self, ops, dt):
        ops.move_particles(dt, flip=1.2)


class Still(Sound, VelocityUpdate):
    """Fault: does not move the particles."""

    def map_to_particles(self, ops, dt):
        ops.update_velocity_gradient()


class TwiceAsFar(Sound, VelocityUpdate):
    def map_to_particles(self, ops, dt):
        ops.move_particles(2 * dt, flip=1.0)


class Twice(Sound, VelocityUpdate):
    """Fault: adds the change of the step twice."""

    def map_to_particles(self, ops, dt):
        ops.move_particles(dt, flip=1.0)
        ops.move_particles(0.0, flip=1.0)


class BearsNothing(Undamped):
    acoustic_fraction = 0
