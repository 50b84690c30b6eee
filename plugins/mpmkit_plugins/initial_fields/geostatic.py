"""The stress of a body that rests under its weight."""

from __future__ import annotations

import numpy as np

from mpmkit.contracts import Beginning, InitialField, Space, hookimpl, quantity


class _Geostatic(InitialField):
    """σ = -(load + ρ g depth) along gravity, K0 times that across it."""

    level: float | None = quantity(
        "m",
        "place along gravity's axis at which the weight begins; default: the top of the body",
        default=None,
    )
    load: float = quantity("Pa", "pressure on it at this level", default=0.0, ge=0)

    def problem(self, space: Space, field: str, shape: tuple[int, ...]) -> str | None:
        return None if field == "stress" else f"it gives a stress, and not {field}"

    def _across(self) -> float:
        """Stress across gravity over that along it."""
        return 1.0

    def at(self, start: Beginning) -> np.ndarray:
        strength = np.linalg.norm(start.gravity)
        up = -start.gravity / strength if strength else np.zeros_like(start.gravity)
        axis = int(np.argmax(np.abs(up)))
        top = start.top if self.level is None else self.level * float(np.sign(up[axis]))
        depth = np.maximum(0.0, top - (start.position * up).sum(axis=1))
        along = -(self.load + start.density * strength * depth)
        stress = np.zeros((len(along), 6))
        stress[:, :3] = self._across() * along[:, None]
        stress[:, axis] = along
        return stress


class Hydrostatic(_Geostatic):
    """The pressure of a fluid at rest, p = load + ρ g depth."""

    name = "hydrostatic"
    api_version = 2
    citation = "none: a definition"


class K0(_Geostatic):
    """The stress at rest of a wide layer of soil: ρ g depth along gravity, K0 times that across it."""

    name = "k0"
    api_version = 2
    citation = "Jaky, J. Soc. Hung. Archit. Eng. (1944) 355-358"

    ratio: float = quantity("1", "K0, stress across gravity over that along it", ge=0)

    def _across(self) -> float:
        return self.ratio


@hookimpl
def mpmkit_initial_fields() -> list[type[InitialField]]:
    return [Hydrostatic, K0]
