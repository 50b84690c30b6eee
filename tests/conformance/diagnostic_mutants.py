"""A correct diagnostic, and mutants of it with one fault each."""

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import Column, Diagnostic


class Fastest(Sound, Diagnostic):
    """Correct: the largest speed."""

    def columns(self, space):
        return [Column("speed", "m/s", "largest speed")]

    def measure(self, scene):
        return {"speed": float(np.linalg.norm(scene.velocity, axis=1).max())}


class Nowhere(Fastest):
    def problem(self, space, walls):
        return "it cannot be measured"


class SaysNothing(Fastest):
    def problem(self, space, walls):
        return "" if space.radial else None


class NoUnit(Fastest):
    def columns(self, space):
        return [Column("speed", "", "largest speed")]


class BadName(Fastest):
    def columns(self, space):
        return [Column("Largest speed", "m/s", "largest speed")]


class Renamed(Fastest):
    def measure(self, scene):
        return {"velocity": 1.0}


class AText(Fastest):
    def measure(self, scene):
        return {"speed": "fast"}


class AnArray(Fastest):
    def measure(self, scene):
        return {"speed": np.linalg.norm(scene.velocity, axis=1)}


class StopsIt(Fastest):
    """Fault: writes to the scene."""

    def measure(self, scene):
        scene.velocity[:] = 0.0
        return {"speed": 0.0}


class ByChance(Fastest):
    def measure(self, scene):
        return {"speed": float(np.random.default_rng().uniform())}


class OfTheFirst(Fastest):
    """Fault: measures the first particle in memory, so that the order matters."""

    def measure(self, scene):
        return {"speed": float(np.linalg.norm(scene.velocity[0]))}


class OverNothing(Fastest):
    def measure(self, scene):
        return {"speed": np.inf}
