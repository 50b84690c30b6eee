"""A wall without friction that pushes and does not pull."""

from mpmkit.contracts import Contact, ContactNodes, StateVariable, hookimpl


class Slip(Contact):
    """v_n ≥ w_n: the wall stops material that approaches it, lets material leave, and has no friction.

    Whether it pushes at a node is decided once a step, after the momentum equation. Until the next decision
    the normal velocity is held, whatever its sign: a contact that opened as soon as the mapped velocity
    turned would strain the last cell on approach but never on departure, and would feed energy in.
    """

    name = "slip"
    api_version = 2
    citation = "Bardenhagen, Brackbill & Sulsky, Comput. Methods Appl. Mech. Eng. 187 (2000) 529-541"

    memory = {"contact": StateVariable("1", "1 where the wall pushes, 0 elsewhere")}

    def mapped(self, nodes: ContactNodes) -> None:
        nodes.stop(nodes.touched & (nodes.memory["contact"] == 1))

    def solved(self, nodes: ContactNodes, dt: float) -> None:
        away, _ = nodes.slip()
        pushes = nodes.touched & (away < 0)
        nodes.stop(pushes)
        nodes.memory["contact"][:] = pushes


@hookimpl
def mpmkit_contacts() -> list[type[Contact]]:
    return [Slip]
