"""A wall along which material slips in proportion to the shear rate at the wall."""

from typing import Any

import numpy as np

from mpmkit.contracts import ContactNodes, hookimpl, quantity
from mpmkit.contracts.contact import Parity

from .slip import Slip


class NavierSlip(Slip):
    """u_t = b ∂u_t/∂n at the wall, with the slip length b. For a linear profile, u_t = u_t(y) b / (b + y).

    u_t(y) is the tangential velocity of the material at the depth y. Along the normal the contact is that of
    ``slip``. Friction moves the slip velocity towards that value, but never makes the material faster. With
    b = 0 the material sticks as with ``stick``; a large b tends to ``slip``.
    """

    name = "navier-slip"
    api_version = 2
    citation = "Navier, Mém. Acad. R. Sci. Inst. France 6 (1823) 389-440"

    slip_length: float = quantity("m", "slip length b", ge=0)

    @property
    def parity(self) -> Parity:  # type: ignore[override]
        return "odd" if self.slip_length == 0 else "mirror"

    def cautions(self, case: Any) -> list[str]:
        if self.slip_length == 0:
            return []
        return [
            "contact 'navier-slip' makes the slip 5 % too small in a film of 10 cells, where the wall lies "
            "on rows of nodes; on a wall between the rows, or at an angle to them, the slip is too large, by "
            "9 to 93 % in the validation report: put the wall on nodes, or take the slip for an estimate"
        ]

    def mapped(self, nodes: ContactNodes) -> None:
        super().mapped(nodes)
        self._drag(nodes)

    def solved(self, nodes: ContactNodes, dt: float) -> None:
        super().solved(nodes, dt)
        self._drag(nodes)

    def _drag(self, nodes: ContactNodes) -> None:
        """Where the wall pushes, u_t becomes the shortest vector between what it is and what it tends to."""
        _, slip = nodes.slip()
        b, y = self.slip_length, nodes.depth
        excess = slip - (b / (b + y))[:, None] * nodes.tangential(nodes.inner)
        square = (excess * excess).sum(axis=1)
        part = (excess * slip).sum(axis=1) / np.where(square > 0, square, 1.0)
        pushes = nodes.touched & (nodes.memory["contact"] == 1)
        nodes.brake(pushes, np.clip(part, 0.0, 1.0)[:, None] * excess)


@hookimpl
def mpmkit_contacts() -> list[type[Slip]]:
    return [NavierSlip]
