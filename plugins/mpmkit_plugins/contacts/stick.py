"""A wall to which material sticks."""

from pydantic import Field

from mpmkit.contracts import Contact, ContactNodes, StateVariable, hookimpl


class Stick(Contact):
    """v = w at every node that material touches; with ``releases``, only until the material leaves.

    Whether a wall that releases holds a node is decided once a step, as for ``slip``.
    """

    name = "stick"
    api_version = 2
    citation = "Sulsky, Chen & Schreyer, Comput. Methods Appl. Mech. Eng. 118 (1994) 179-196"

    releases: bool = Field(default=False, description="whether it releases material that is pulled away")

    parity = "odd"
    memory = {"contact": StateVariable("1", "1 where the wall holds the material, 0 elsewhere")}

    @property
    def pulls(self) -> bool:  # type: ignore[override]
        return not self.releases

    def mapped(self, nodes: ContactNodes) -> None:
        held = nodes.touched & ((nodes.memory["contact"] == 1) | (not self.releases))
        nodes.velocity[held] = nodes.wall_velocity[held]

    def solved(self, nodes: ContactNodes, dt: float) -> None:
        away, _ = nodes.slip()
        held = nodes.touched & ((away < 0) | (not self.releases))
        nodes.velocity[held] = nodes.wall_velocity[held]
        nodes.memory["contact"][:] = held


@hookimpl
def mpmkit_contacts() -> list[type[Contact]]:
    return [Stick]
