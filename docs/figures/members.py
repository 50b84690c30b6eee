"""The runs behind docs/accuracy.md: the slump of the paper's concrete, with one thing changed at a time."""

from collections.abc import Callable
from dataclasses import dataclass

from common import DOCS
from floors import hold_floor

import mpmkit

Overrides = list[str]


@dataclass(frozen=True)
class Member:
    """A run: what to call it in files and in legends, its case, and what is done to it from outside."""

    name: str
    label: str
    case: str
    overrides: Overrides
    prepare: Callable[[mpmkit.Simulation], None] | None = None

    def simulation(self) -> mpmkit.Simulation:
        simulation = mpmkit.Simulation(
            mpmkit.load_case(DOCS.parent / f"cases/{self.case}.json", self.overrides)
        )
        if self.prepare is not None:
            self.prepare(simulation)
        return simulation


def sound(factor: float) -> str:
    """c = factor √(2 g h)."""
    return f'bodies.0.material.sound_speed={{"factor": {factor}}}'


def cells(millimetres: float) -> Overrides:
    """Another cell size, with a domain that is a whole number of them."""
    height = 0.3 + millimetres / 1000
    return [
        f"grid.cell_size={millimetres / 1000}",
        f'grid.domain={{"r": [0, 0.36], "z": [0, {height:g}]}}',
    ]


WITHOUT = "scheme.redistribution=none"


def published(*changes: str) -> Overrides:
    """The accurate case turned back into the paper's, but for the law and what is changed."""
    return [
        sound(50),
        "scheme.velocity=flip",
        "scheme.volumetric=own",
        'scheme.shape={"name":"cpgimp","domain":"fixed"}',
        WITHOUT,
        *changes,
    ]


APIC, AVERAGE = "scheme.velocity=apic", "scheme.volumetric=nodal-average"

CURES = [
    Member(
        "held",
        "the paper's settings, ghosts of the floor held at zero",
        "slump_as_published",
        ["grid.faces.z_min=open"],
        hold_floor,
    ),
    Member("mirror", "floor as a mirror", "slump_as_published", []),
    Member("exact", "exact yield", "slump", published()),
    Member("average", "volume and pressure averaged", "slump", published(AVERAGE)),
    Member("affine", "affine velocities", "slump", published(AVERAGE, APIC)),
    Member("slower", "c = 10 instead of 50 √(2 g h)", "slump", published(AVERAGE, APIC, sound(10))),
    Member("split", "boxes that follow, splitting", "slump", [WITHOUT, "scheme.splitting=true"]),
    Member("even", "places kept even instead: the default", "slump", []),
]
"""Each cure added to the ones before it, 5 mm."""

CELLS = [Member(f"cells_{mm:g}", f"{mm:g} mm", "slump", cells(mm)) for mm in (20, 10, 5, 2.5)]
STICK = [
    Member(f"stick_{mm:g}", f"{mm:g} mm", "slump", [*cells(mm), "grid.faces.z_min=stick"])
    for mm in (20, 10, 5)
]
FLOORS = [
    Member("slip", "slip", "slump", cells(10)),
    *(
        Member(
            f"friction_{mu:g}",
            f"Coulomb, {mu:g}",
            "slump",
            [*cells(10), f'grid.faces.z_min={{"kind":"friction","coefficient":{mu}}}'],
        )
        for mu in (0.1, 0.3)
    ),
    Member("stick", "stick", "slump", [*cells(10), "grid.faces.z_min=stick"]),
]
SOUND = [Member(f"sound_{k}", f"{k} √(2 g h)", "slump", [*cells(10), sound(k)]) for k in (50, 20, 10, 5)]
STIFFNESS = [
    Member(
        f"modulus_{G:g}",
        f"G = {G / 1000:g} kPa",
        "slump",
        [*cells(10), f"bodies.0.material.shear_modulus={G}"],
    )
    for G in (3e3, 1e4, 3e4, 1e5, 3e5)
]


def regularised(m: float, form: str, *changes: str) -> Overrides:
    law = (
        '{"law":"herschel-bulkley","density":2574,"yield_stress":188.91,"consistency":45.65,"flow_index":1.33,'
        f'"sound_speed":{{"factor":10}},"regularisation":{m},"form":"{form}"}}'
    )
    return [*cells(10), f"bodies.0.material={law}", *changes]


REGULARISATION = [
    *(
        Member(f"relaxed_{m:g}", f"relaxed, m = {m:g} s", "slump", regularised(m, "relaxed"))
        for m in (10.0, 100.0, 1000.0)
    ),
    *(
        Member(f"explicit_{m:g}", f"explicit, m = {m:g} s", "slump", regularised(m, "explicit"))
        for m in (10.0, 40.0)
    ),
]
ORDERS = [
    Member(f"order_{order}", order.upper(), "slump", [*cells(10), f"scheme.order={order}"])
    for order in ("usl", "usf", "musl")
]
EVERY = [*CELLS[:3], *SOUND, *STIFFNESS, *REGULARISATION, *FLOORS, *ORDERS, *STICK, *CURES, CELLS[3]]
