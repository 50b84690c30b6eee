"""Moments in compact form: integers of 8 and 16 bits, as differences from the previous moment, deflated.

``static/unpack.js`` reads this layout. For each moment, with n particles in the order of their numbers:

1. if the particles are not those of the moment before: their numbers, as n differences of 32 bits;
2. for each axis the position, 16 bits, from the lower to the upper corner of a box around all moments;
3. for each axis of ``half_size`` the half side of the box, 8 bits, of ``longest``;
4. for each quantity its place on the scale of its colours, 8 bits;
5. the body, 8 bits.

Where the particles are those of the moment before, 2 to 5 are the differences to it, modulo 2⁸ or 2¹⁶. A
number of more bits than 8 is written by its bytes, the lowest of all particles first.
"""

from __future__ import annotations

import base64
import zlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...output.flow import Moment

LEVELS_16, LEVELS_8 = 65535, 255


@dataclass(frozen=True)
class Scale:
    """How a quantity is stored in 8 bits: from ``low`` to ``high``, on a linear or logarithmic scale."""

    low: float
    high: float
    logarithmic: bool = False
    gaps: bool = False
    """whether some particles have no value: code 0 is theirs, and the scale begins at code 1"""

    def codes(self, values: np.ndarray) -> np.ndarray:
        """(n,) uint8"""
        low, high, x = self.low, self.high, np.asarray(values, dtype=float)
        if self.logarithmic:
            low, high, x = np.log(low), np.log(high), np.log(np.maximum(x, self.low))
        part = np.clip((x - low) / (high - low), 0.0, 1.0)
        if self.gaps:
            return np.where(np.isnan(part), 0, 1 + np.rint((LEVELS_8 - 1) * part)).astype(np.uint8)
        return np.rint(LEVELS_8 * part).astype(np.uint8)


@dataclass(frozen=True)
class Packed:
    """Moments in base64, and the numbers needed to read them."""

    text: str
    description: dict[str, Any]


def packed(
    moments: Sequence[Moment], scales: Mapping[str, Scale], boxes: np.ndarray, longest: float
) -> Packed:
    """Pack moments.

    Args:
        moments: in order of time; none is empty.
        scales: of the quantities, by the names of the fields of a moment.
        boxes: ``(axes, dim)``, which half sizes are kept: a row of weights for each; their product of powers.
        longest: largest half side that is stored, m; longer ones are cut to it.
    """
    positions = np.concatenate([moment.position for moment in moments]).astype(float)
    lower, upper = positions.min(axis=0), positions.max(axis=0)
    extent = np.where(upper > lower, upper - lower, 1.0)
    content, listed, before = bytearray(), [], None
    planes_before: list[np.ndarray] = []
    for moment in moments:
        same = before is not None and np.array_equal(moment.number, before.number)
        codes = np.rint(LEVELS_16 * (moment.position - lower) / extent).clip(0, LEVELS_16).astype(np.uint16)
        half = np.exp(np.log(np.maximum(moment.half_size.astype(float), 1e-300)) @ boxes.T)
        sizes = np.rint(LEVELS_8 * (half / longest).clip(0, 1)).clip(1).astype(np.uint8)
        planes = [*codes.T, *sizes.T, *(s.codes(moment.values(q)) for q, s in scales.items()), moment.body]
        if not same:
            content += _bytes(np.diff(moment.number, prepend=0).astype(np.uint32))
        for place, plane in enumerate(planes):
            content += _bytes(plane - planes_before[place] if same else plane)
        listed.append({"time": moment.time, "count": len(moment), "same": same, "share": moment.share})
        before, planes_before = moment, planes
    return Packed(
        base64.b64encode(zlib.compress(bytes(content), 9)).decode(),
        {
            "moments": listed,
            "lower": lower.tolist(),
            "extent": extent.tolist(),
            "sizes": len(boxes),
            "longest": longest,
            "quantities": list(scales),
        },
    )


def _bytes(plane: np.ndarray) -> bytes:
    """One number of each particle, byte by byte: first the lowest bytes of all particles."""
    rows = np.ascontiguousarray(plane.astype(plane.dtype.newbyteorder("<")))
    return np.ascontiguousarray(rows.view(np.uint8).reshape(len(plane), -1).T).tobytes()


def unpacked(packing: Packed) -> list[dict[str, np.ndarray]]:
    """What a browser reads of each moment: positions, half sizes, m, codes of quantities, bodies, numbers."""
    content = zlib.decompress(base64.b64decode(packing.text))
    about, at, found = packing.description, 0, []
    lower, extent = np.array(about["lower"]), np.array(about["extent"])
    before: dict[str, np.ndarray] = {}

    def take(kind: type, count: int) -> np.ndarray:
        nonlocal at
        width = np.dtype(kind).itemsize
        part = np.frombuffer(content, np.uint8, count * width, at).reshape(width, count)
        at += count * width
        return np.ascontiguousarray(part.T).view(np.dtype(kind).newbyteorder("<")).ravel().astype(kind)

    for moment in about["moments"]:
        count, planes = moment["count"], {}
        number = before["number"] if moment["same"] else np.cumsum(take(np.uint32, count).astype(np.int64))
        kinds: list[tuple[str, type]] = [(f"position.{axis}", np.uint16) for axis in range(len(lower))]
        kinds += [(f"half_size.{axis}", np.uint8) for axis in range(about["sizes"])]
        kinds += [(name, np.uint8) for name in (*about["quantities"], "body")]
        for name, kind in kinds:
            plane = take(kind, count)
            planes[name] = plane + before[name] if moment["same"] else plane
        before = planes | {"number": number}
        codes = np.stack([planes[f"position.{axis}"] for axis in range(len(lower))], axis=1)
        sizes = np.stack([planes[f"half_size.{axis}"] for axis in range(about["sizes"])], axis=1)
        found.append(
            before
            | {
                "position": lower + extent * codes / LEVELS_16,
                "half_size": about["longest"] * sizes / LEVELS_8,
            }
        )
    return found
