"""A wall with Coulomb friction."""

import numpy as np

from mpmkit.contracts import ContactNodes, hookimpl, quantity

from .slip import Slip


class Coulomb(Slip):
    """As ``slip``, with friction: it reduces the slip velocity u_t by at most μ times the push, to 0 at most.

    u_t ← (1 - min(1, μ push / |u_t|)) u_t. The push is the change of the normal velocity by the wall at this
    node, including the impulses of the mirrored material behind the wall and of neighbouring nodes.
    """

    name = "coulomb"
    api_version = 2
    citation = "Bardenhagen, Brackbill & Sulsky, Comput. Methods Appl. Mech. Eng. 187 (2000) 529-541"

    counts_push = True

    coefficient: float = quantity("1", "Coulomb friction coefficient μ", ge=0)

    def solved(self, nodes: ContactNodes, dt: float) -> None:
        away, slip = nodes.slip()
        super().solved(nodes, dt)
        push = np.maximum(np.maximum(-away, 0.0) + nodes.pressed, 0.0)
        speed, grip = np.linalg.norm(slip, axis=1), self.coefficient * push
        lost = np.where(grip < speed, grip / np.where(speed > 0, speed, 1.0), 1.0)
        nodes.brake(nodes.touched, lost[:, None] * slip)


@hookimpl
def mpmkit_contacts() -> list[type[Slip]]:
    return [Coulomb]
