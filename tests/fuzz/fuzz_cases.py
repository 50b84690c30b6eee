"""Hypothesis strategies of case files: valid ones, made from the schema, and invalid ones."""

from __future__ import annotations

import copy
import json
import math
from collections.abc import Iterator
from typing import Any

import numpy as np
from fuzz_values import SCHEMA, logarithmic, parameters, resolve, value_of
from fuzz_walls import Block, walls
from hypothesis import strategies as st

from mpmkit.case import parse_case
from mpmkit.case.plugins import SCHEME
from mpmkit.registry import installed
from mpmkit.spaces import SPACES

ROOM = 2
"""Cells between a body and an open face: farther than three steps lead."""
CLOSED = ("slip", "stick", "symmetry", {"kind": "friction", "coefficient": 0.3})


def plugins(kind: str) -> st.SearchStrategy[Any]:
    """A registered scheme, by its name or with parameters."""
    options = SCHEMA["$defs"]["Scheme"]["properties"][kind]
    return st.one_of([value_of(option) for entry in options["oneOf"] for option in resolve(entry)["anyOf"]])


@st.composite
def materials(draw: st.DrawFn, weightless: bool) -> dict[str, Any]:
    laws = {name: d for name, d in SCHEMA["$defs"].items() if name.startswith("Material_")}
    node = laws[draw(st.sampled_from(sorted(laws)))]
    name = node["properties"]["law"]["const"]
    found = draw(parameters(node, but=("sound_speed", "density")))
    found["density"] = draw(logarithmic(2, 4))
    if installed().of_kind("law")[name].uses_equation_of_state:
        speeds = [logarithmic(0.5, 2.5)]
        if not weightless:
            speeds += [st.fixed_dictionaries({"factor": logarithmic(0.5, 2)})]
            speeds += [st.fixed_dictionaries({"mach": logarithmic(-2, -0.5)})]
        found["sound_speed"] = draw(st.one_of(speeds))
    return found


@st.composite
def valid_cases(draw: st.DrawFn, walled: bool | None = None) -> dict[str, Any]:
    """A scene of one or two bodies on a few cells that must run; with walls, without, or either."""
    space = draw(st.sampled_from(sorted(SPACES)))
    axes, radial = SPACES[space].axes, SPACES[space].radial
    cell = draw(logarithmic(-3, 1))
    faces = draw(_faces(axes, radial))
    size = [draw(st.integers(2, 4 if len(axes) == 2 else 3)) for _ in axes]
    two = draw(st.booleans())
    lower, cells, corner = [], [], []
    for a, axis in enumerate(axes):
        lower.append(0 if radial and a == 0 else draw(st.integers(-5, 5)))
        before, behind = (0 if f"{axis}_{side}" in faces else ROOM for side in ("min", "max"))
        before = 0 if radial and a == 0 else before
        corner.append(lower[a] + before)
        cells.append(before + size[a] * (1 + (two and a == len(axes) - 1)) + behind)
    weightless = draw(st.booleans())
    bodies = []
    for number in range(1 + two):
        begin = [*corner[:-1], corner[-1] + number * size[-1]]
        material = draw(materials(weightless))
        bodies.append({"shape": draw(_shapes(space, begin, size, cell)), "material": material})
        if draw(st.booleans()):
            bodies[-1]["velocity"] = [
                0.0 if radial and a == 0 else draw(st.sampled_from([-1.0, 0.0, 0.25]))
                for a in range(len(axes))
            ]
        if draw(st.booleans()):
            bodies[-1]["particles_per_cell"] = draw(
                st.sampled_from([1, 2 ** len(axes), [2] * len(axes), [1, 2, 3][: len(axes)]])
            )
    scheme = {k: draw(plugins(k)) for k in SCHEME if draw(st.booleans())}
    if "refinement" not in scheme and draw(st.booleans()):
        scheme["splitting"] = draw(st.booleans())
    if draw(st.booleans()):
        scheme["time_step"] = {"fraction": draw(st.sampled_from([0.1, 0.4, 0.5]))}
    case = {
        "space": space,
        "until": draw(logarithmic(-6, 3)),
        "grid": {
            "cell_size": cell,
            "domain": {
                axis: [low * cell, (low + n) * cell] for axis, low, n in zip(axes, lower, cells, strict=True)
            },
            "faces": faces,
        },
        "bodies": bodies,
        "scheme": scheme,
        "output": {"report": False},
    }
    if weightless:
        case["gravity"] = [0.0] * len(axes)
    if draw(st.booleans()):
        case["output"]["particle_history"] = ["position", "stress"]
    _slower_than_sound(case, cell * sum(size))
    if draw(st.booleans()) if walled is None else walled:
        extent = np.array([*size[:-1], size[-1] * (1 + two)])
        lower, until = cell * np.array(corner, dtype=float), case["until"]
        block = Block(space, lower, lower + cell * extent, cell, until, _slowest_wave(case) / 10)
        case["walls"] = draw(walls(block))
    return case


def _slowest_wave(case: dict[str, Any]) -> float:
    """m/s, in any of the materials."""
    parsed = parse_case(case)
    materials = [body.material for body in parsed.bodies]
    return min(m.constitutive_law.wave_speed(m.density, parsed.sound_speed(m)) for m in materials)


def _slower_than_sound(case: dict[str, Any], height: float) -> None:
    """Gravity and speeds are far below the wave speed of the softest material. A sound speed that is computed
    from the height of fall fits gravity already."""
    own = [
        body.material.constitutive_law.wave_speed(body.material.density, body.material.sound_speed)
        for body in parse_case(case).bodies
        if isinstance(body.material.sound_speed, float | None)
    ]
    slowest = min(own, default=math.inf)
    if "gravity" not in case and slowest < math.inf:
        case["gravity"] = [0.0] * len(case["grid"]["domain"])
        case["gravity"][-1] = -min(9.81, (slowest / 3) ** 2 / (2 * height))
    for body in case["bodies"]:
        if "velocity" in body:
            body["velocity"] = [x * min(1.0, slowest / 10) for x in body["velocity"]]


@st.composite
def _faces(draw: st.DrawFn, axes: tuple[str, ...], radial: bool) -> dict[str, Any]:
    faces = {}
    for a, axis in enumerate(axes):
        if not (radial and a == 0) and draw(st.integers(0, 3)) == 0:
            faces[f"{axis}_min"] = faces[f"{axis}_max"] = "periodic"
            continue
        for side in ("max",) if radial and a == 0 else ("min", "max"):
            if draw(st.booleans()):
                faces[f"{axis}_{side}"] = draw(st.sampled_from(CLOSED))
    return faces


@st.composite
def _shapes(draw: st.DrawFn, space: str, begin: list[int], size: list[int], cell: float) -> dict[str, Any]:
    """A shape that fits a block of cells."""
    radial, low, high = space == "axisymmetric", [cell * x for x in begin], []
    high = [cell * (x + n) for x, n in zip(begin, size, strict=True)]
    middle = [0.0 if radial and a == 0 else (low[a] + high[a]) / 2 for a in range(len(size))]
    reach = min(size[:-1]) * cell / (1 if radial else 2)
    radius = 0.999 * min(reach, size[-1] * cell / 2)
    base = [*middle[:-1], low[-1]]
    height = 0.999 * size[-1] * cell
    kind = draw(st.sampled_from(["box", "cylinder", "frustum", "sphere"]))
    if kind == "box":
        return {"kind": "box", "lower": low, "upper": high}
    if kind == "sphere":
        return {"kind": "sphere", "centre": middle, "radius": radius}
    if kind == "cylinder":
        return {"kind": "cylinder", "radius": 0.999 * reach, "height": height, "base": base}
    radii = {"bottom_radius": 0.999 * reach, "top_radius": draw(st.sampled_from([0.0, 0.5 * reach]))}
    return {"kind": "frustum", **radii, "height": height, "base": base}


# --- What may be wrong

PAYLOADS = [
    "__import__('os').system('touch executed')",
    "$(touch executed)",
    "`touch executed`",
    "{{7*7}}",
    "!!python/object/apply:os.system ['touch executed']",
    "cos\nsystem\n(S'touch executed'\ntR.",
    "file:///etc/passwd",
    "../../../../etc/passwd",
    "/dev/zero",
    "a\x00b",
    "￾\u202e",
]
"""Texts that would do something if anything took them for more than text."""
TRICKS = [
    "..",
    ".",
    "../up",
    "/tmp/up",
    "a/b",
    "a\\b",
    "~",
    "~root",
    "a\x00",
    "a\n",
    "",
    " ",
    "-rf",
    "x" * 5000,
]
"""Names of a run directory that would lead out of it."""


NEEDED = [
    ("space",), ("until",), ("grid",), ("bodies",), ("grid", "cell_size"), ("grid", "domain"),
    ("bodies", 0, "shape"), ("bodies", 0, "material"), ("bodies", 0, "material", "density"),
]  # fmt: skip


def junk() -> st.SearchStrategy[Any]:
    """Any JSON, huge numbers and much nested lists included."""
    scalars = st.one_of(
        st.none(),
        st.booleans(),
        st.integers(),
        st.sampled_from([10**9, -(10**9), 2**31, 2**63, 10**30, 10**399]),
        st.floats(allow_nan=False, allow_infinity=False),
        st.sampled_from([1e308, -1e308, 5e-324, 1e-300, 0.0, -0.0, 1e9, 1e-9]),
        st.text(max_size=20),
        st.sampled_from(PAYLOADS),
    )
    nested = st.integers(1, 300).map(lambda depth: json.loads("[" * depth + "]" * depth))
    return st.one_of(
        st.recursive(
            scalars,
            lambda inner: (
                st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=8), inner, max_size=4)
            ),
            max_leaves=8,
        ),
        nested,
    )


def places(data: Any, path: tuple = ()) -> Iterator[tuple]:
    """Paths of everything in a document."""
    if path:
        yield path
    items = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, item in items:
        yield from places(item, (*path, key))


def parent(data: Any, path: tuple) -> Any:
    for key in path[:-1]:
        data = data[key]
    return data


@st.composite
def mutants(draw: st.DrawFn, walled: bool | None = None) -> dict[str, Any]:
    """A valid case with one to three of its entries replaced, removed or added; some are still valid.

    ``walled``: as for valid cases; with walls only these change, or nothing does.
    """
    data = copy.deepcopy(draw(valid_cases(walled)))
    for _ in range(draw(st.integers(0 if walled else 1, 3))):
        here = sorted((p for p in places(data) if not walled or p[0] == "walls"), key=str)
        if not here:
            break
        path = draw(st.sampled_from(here))
        holder = parent(data, path)
        match draw(st.sampled_from(["replace", "scale", "remove", "add"])):
            case "replace":
                holder[path[-1]] = draw(junk())
            case "scale":
                value = holder[path[-1]]
                if (
                    isinstance(value, float | int) and abs(value) < 1e300
                ):  # Python multiplies no larger integers
                    holder[path[-1]] *= draw(
                        st.sampled_from([-1, 0, 1e-12, 1e-6, 1e-3, 1e3, 1e6, 1e12, 1e200])
                    )
            case "remove":
                del holder[path[-1]]
            case _ if isinstance(holder, dict):
                holder[draw(st.text(max_size=10))] = draw(junk())
            case _:
                holder.append(draw(junk()))
    return data


@st.composite
def invalid_cases(draw: st.DrawFn) -> dict[str, Any]:
    """A valid case with one invalid entry at any place."""
    data = copy.deepcopy(draw(valid_cases()))
    what = draw(
        st.sampled_from(["unknown key", "wrong type", "missing", "not above zero", "too many", "name"])
    )
    if what == "unknown key":
        objects = [()] + [path for path in places(data) if isinstance(_at(data, path), dict)]
        _at(data, draw(st.sampled_from(sorted(objects, key=str))))["no such key"] = draw(junk())
    elif what == "wrong type":
        wrong = {"bodies": 3, "grid": [], "space": 1.5, "scheme": "usl", "until": "soon", "gravity": "down"}
        key = draw(st.sampled_from(sorted(wrong)))
        data[key] = wrong[key]
    elif what == "missing":
        path = draw(st.sampled_from(NEEDED))
        del parent(data, path)[path[-1]]
    elif what == "not above zero":
        path = draw(
            st.sampled_from([("until",), ("grid", "cell_size"), ("bodies", 0, "material", "density")])
        )
        parent(data, path)[path[-1]] = draw(
            st.one_of(st.just(0.0), st.floats(max_value=0, allow_infinity=False))
        )
    elif what == "too many":  # a billion particles and more
        data["bodies"][0]["particles_per_cell"] = 1000
        data["grid"]["cell_size"] /= 1000 if len(data["grid"]["domain"]) == 3 else 1_000_000
    else:
        data["name"] = draw(st.sampled_from(TRICKS))
    return data


def _at(data: Any, path: tuple) -> Any:
    for key in path:
        data = data[key]
    return data


@st.composite
def broken_texts(draw: st.DrawFn) -> bytes:
    """A file that once was a case: cut, spliced, nested, or with bytes that no text has."""
    text = json.dumps(draw(valid_cases())).encode()
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, len(text)))
        match draw(st.sampled_from(["cut", "bytes", "repeat", "nest", "number", "text"])):
            case "cut":
                text = text[:at]
            case "bytes":
                text = text[:at] + draw(st.binary(max_size=6)) + text[at:]
            case "repeat":
                text = text[:at] + text[at : at + draw(st.integers(1, 60))] * 2 + text[at:]
            case "nest":
                text = text[:at] + draw(st.sampled_from([b"[", b'{"a":'])) * draw(
                    st.sampled_from([10, 990, 1_000, 100_000])
                )
            case "number":
                digits = draw(
                    st.sampled_from([b"1e999", b"NaN", b"-Infinity", b"9" * 5_000, b"1e-999", b"0x10"])
                )
                text = text.replace(b"0", digits, 1) if b"0" in text else digits
            case _:
                text = text.replace(b'"', b'"' + draw(st.text(max_size=5)).encode(), 1)
    return text
