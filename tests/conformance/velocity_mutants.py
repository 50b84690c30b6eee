"""A velocity update with nothing wrong with it, and some with one fault each."""

from sound_laws import Sound

from mpmkit.contracts import VelocityUpdate


class Undamped(Sound, VelocityUpdate):
    """FLIP, which has nothing wrong with it."""

    def map_to_particles(self, ops, dt):
        ops.move_particles(dt, flip=1.0)


class Amplified(Sound, VelocityUpdate):
    """Makes what the grid does not see grow by a fifth in each step."""

    def map_to_particles(self, ops, dt):
        ops.move_particles(dt, flip=1.2)


class Still(Sound, VelocityUpdate):
    """Moves nothing."""

    def map_to_particles(self, ops, dt):
        ops.update_velocity_gradient()


class TwiceAsFar(Sound, VelocityUpdate):
    def map_to_particles(self, ops, dt):
        ops.move_particles(2 * dt, flip=1.0)


class Twice(Sound, VelocityUpdate):
    """Adds the change of the step twice."""

    def map_to_particles(self, ops, dt):
        ops.move_particles(dt, flip=1.0)
        ops.move_particles(0.0, flip=1.0)


class BearsNothing(Undamped):
    acoustic_fraction = 0
