"""A wall with Coulomb friction."""

import numpy as np

from mpmkit.contracts import ContactNodes, hookimpl, quantity

from .slip import Slip


class Coulomb(Slip):
    """As ``slip``, and the drag takes at most μ times the push from the slip, and never turns it round:

    u_t ← (1 - min(1, μ push / |u_t|)) u_t, with the push the normal velocity that the wall takes up, here, by
    what is mirrored beyond it, and with its neighbours.
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
