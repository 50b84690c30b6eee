"""A correct contact, and mutants of it with one fault each."""

from typing import ClassVar

import numpy as np
from sound_laws import Sound

from mpmkit.contracts import Contact, StateVariable


class Sticky(Sound, Contact):
    """Correct: stops approaching material, halves its slip velocity, and remembers the approach velocity."""

    memory = {"impact": StateVariable("m/s", "speed of the last impact")}

    def mapped(self, nodes):
        away, _ = nodes.slip()
        nodes.stop(nodes.touched & (nodes.memory["impact"] > 0) & (away < 0))

    def solved(self, nodes, dt):
        away, slip = nodes.slip()
        hit = nodes.touched & (away < 0)
        nodes.stop(hit)
        nodes.brake(hit, 0.5 * slip)
        nodes.memory["impact"][:] = np.where(hit, -away, 0.0)


class EveryNode(Sticky):
    def mapped(self, nodes):
        nodes.velocity[:] = nodes.wall_velocity


class Pulls(Sticky):
    def solved(self, nodes, dt):
        nodes.stop(nodes.touched)


class Bounces(Sticky):
    """Fault: material leaves faster than it approached."""

    def solved(self, nodes, dt):
        away, _ = nodes.slip()
        hit = nodes.touched & (away < 0)
        nodes.velocity[hit] -= (2.1 * away[:, None] * nodes.normal)[hit]


class Downwards(Sticky):
    """Fault: treats the last axis in a special way."""

    def solved(self, nodes, dt):
        lost = np.zeros_like(nodes.velocity)
        lost[:, -1] = 0.1 * nodes.slip()[1][:, -1]
        away, _ = nodes.slip()
        nodes.brake(nodes.touched & (away < 0), lost)


class AtRestOnly(Sticky):
    """Fault: ignores the velocity of the wall."""

    def solved(self, nodes, dt):
        away = (nodes.velocity * nodes.normal).sum(axis=1)
        hit = nodes.touched & (away < 0)
        nodes.velocity[hit] -= (away[:, None] * nodes.normal)[hit]


class Drives(Sticky):
    """Fault: friction with the wrong sign."""

    def solved(self, nodes, dt):
        away, slip = nodes.slip()
        hit = nodes.touched & (away < 0)
        nodes.stop(hit)
        nodes.brake(hit, -2.0 * slip)


class DividesByTheSlip(Sticky):
    def solved(self, nodes, dt):
        away, slip = nodes.slip()
        hit = nodes.touched & (away < 0)
        with np.errstate(all="ignore"):
            nodes.brake(hit, 0.1 * slip / np.linalg.norm(slip, axis=1)[:, None])


class Replaces(Sticky):
    def mapped(self, nodes):
        nodes.velocity = nodes.velocity.copy()


class Forgets(Sticky):
    def solved(self, nodes, dt):
        nodes.memory = {}


class Returns(Sticky):
    def mapped(self, nodes):
        return nodes.velocity


class WritesTheWall(Sticky):
    def mapped(self, nodes):
        nodes.wall_velocity[:] = nodes.velocity


class Touches(Sticky):
    def mapped(self, nodes):
        nodes.touched[:] = True


class KnowsTheOthers(Sticky):
    def solved(self, nodes, dt):
        _, slip = nodes.slip()
        nodes.brake(nodes.touched, 0.1 * (np.arange(len(slip)) % 2)[:, None] * slip)


class HiddenMemory(Sticky):
    calls: ClassVar[list] = []

    def solved(self, nodes, dt):
        _, slip = nodes.slip()
        self.calls.append(1)
        nodes.brake(nodes.touched, slip / (1 + len(self.calls)))


class NoParity(Sticky):
    parity = "even"


class Rows(Sticky):
    memory = {"impact": StateVariable("m/s", "velocity of the last impact", shape=(3,))}
