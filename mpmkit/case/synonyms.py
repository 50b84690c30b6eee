"""Common words for the names of a case: the meaning of, for example, "no-slip" or "water".

By spelling alone, "no-slip" would be taken for "slip", the opposite. A word may have several names as
meanings. If no name has the meaning of a word, such as "plane-stress", nothing is suggested.
"""

from __future__ import annotations

import difflib
import re
from collections.abc import Iterable
from typing import Any

LONGEST = 60
"""Most characters of a word that are compared."""

WORDS: dict[tuple[str, ...], str] = {
    # faces
    ("stick",): (
        "no slip, non slip, zero slip, sticky, sticking, rough, fixed, wall, closed, solid, rigid, clamped, "
        "adhesive, adherent, bonded, glued, dirichlet"
    ),
    ("slip",): (
        "free slip, full slip, perfect slip, frictionless, no friction, smooth, lubricated, sliding, roller"
    ),
    ("slip", "open"): "free",
    ("open",): "outflow, outlet, free surface, none, nothing, air, void, unbounded",
    ("friction",): "coulomb, frictional, partial slip, rough friction",
    ("coulomb",): "friction, frictional, coulomb friction, dry friction",
    ("navier-slip",): "navier, slip length, partial slip, linear slip",
    ("periodic",): "cyclic, wrap, repeating",
    ("symmetry",): "symmetric, symmetrical, mirror, mirrored, reflecting, axis",
    (): (
        "moving, moving wall, inflow, inlet, plane stress, quadratic, cubic, bspline, "
        "quadratic bspline, cubic bspline, cpdi, tpic, xpic, aflip, asflip, tait, cole, mohr coulomb, "
        "drucker prager, inviscid"
    ),
    # spaces
    ("plane-strain", "axisymmetric"): "2d, two dimensional",
    ("plane-strain",): "plane, planar, plane strain 2d, xz, xy",
    ("axisymmetric",): (
        "axisymmetry, axial, axially symmetric, axisym, rz, cylindrical, rotational, 2.5d, 2d axisymmetric"
    ),
    ("3d",): "three dimensional, cartesian, full, spatial, xyz",
    # laws
    ("bingham-evp", "bingham"): "viscoplastic, plastic, bingham fluid, bingham plastic",
    ("bingham",): "bingham papanastasiou, papanastasiou, regularised bingham, regularized bingham",
    ("herschel-bulkley-evp", "herschel-bulkley"): (
        "hb, herschel, bulkley, herschel bulkley fluid, power law, ostwald, ostwald de waele, shear "
        "thinning, shear thickening, non newtonian"
    ),
    ("herschel-bulkley",): "herschel bulkley papanastasiou, regularised herschel bulkley",
    ("bingham-evp",): "elastoviscoplastic, evp, saramito, exact bingham",
    ("herschel-bulkley-evp",): "hb evp, hbevp, exact herschel bulkley",
    ("newtonian",): "newton, water, viscous, fluid, liquid, oil, honey, glycerol",
    ("neo-hookean",): "elastic, linear elastic, hyperelastic, hooke, hookean, elasticity, rubber, steel",
    # schemes
    ("usl",): "update stress last, stress last, last",
    ("usf",): "update stress first, stress first, first",
    ("musl",): "modified update stress last, modified usl",
    ("apic",): "affine, affine pic, mls, mls mpm",
    ("blend",): "pic flip, flip pic, picflip blend, flip pic blend, mixed",
    ("cpgimp",): "gimp, ugimp, gimpm, contiguous particle gimp",
    ("linear",): "tent, hat, bilinear, trilinear, p1, q1, fe, standard, mpm",
    ("nodal-average",): "averaged, average, averaging, b bar, f bar, anti locking, nodal",
    ("own",): "particle, off, none, no averaging, not averaged, raw",
    # limits of the time step
    ("acoustic",): "sound, cfl, courant, wave, elastic wave",
    ("viscous",): "viscosity, diffusive, diffusion",
    ("advective",): "advection, convective, convection, velocity",
    # shapes
    ("frustum",): "cone, truncated cone, conical, abrams, abrams cone, slump cone, mini cone",
    ("box",): "cube, cuboid, brick, block, rectangle, square, rectangular, slab, layer",
    ("sphere",): "ball, disc, disk, circle, drop",
    ("cylinder",): "rod, column, tube, pipe",
    ("mesh",): "stl, obj, ply, file, surface, polyhedron, cad",
    # surfaces
    ("plane",): "half space, flat, flat wall, floor",
    ("body",): "shape, solid, obstacle, mould, mold, mesh",
    # motions
    ("rotation",): "rotate, spin, turn, angular",
    ("oscillation",): "oscillate, sine, sinusoidal, vibration, harmonic",
    ("table",): "tabulated, interpolated, points, time series",
    # keys
    ("density",): "rho, mass density",
    ("yield_stress",): "tau0, tau y, tauy, tau 0, yield, yield strength, sigma y, threshold",
    ("plastic_viscosity", "viscosity", "consistency"): "mu, eta",
    ("coefficient",): "friction coefficient, mu, friction",
    ("plastic_viscosity",): "mu p, mup, mu pl",
    ("consistency",): "k, consistency index",
    ("flow_index",): "n, power index, exponent",
    ("regularisation",): "m, regularization, papanastasiou exponent",
    ("youngs_modulus",): "e, young, young modulus, elastic modulus, stiffness",
    ("poisson_ratio",): "nu, poisson, poissons ratio",
    ("shear_modulus",): "g",
    ("sound_speed",): "c, c0, speed of sound",
    ("gravity",): "g",
    ("cell_size",): "dx, h, resolution, spacing, mesh size, grid size, cell",
    ("faces",): "boundaries, boundary, bc, bcs, boundary conditions, walls",
    ("domain",): "extent, extents, bounds, size",
    ("until",): "t end, tend, duration, end time, final time, t max, tmax, total time",
    ("space",): "dim, dimension, dimensions, geometry",
    ("fraction",): "cfl, courant, safety, safety factor",
    ("particles_per_cell",): "ppc, particles, npc",
    ("law",): "model, constitutive, constitutive law, constitutive model, type",
    ("kind", "name"): "type",
    ("shape",): "geometry",
    ("material",): "fluid",
    ("velocity",): "v0, initial velocity, speed, constant velocity, translation, lift",
    ("centre",): "center, middle, origin",
    ("base",): "position, origin, bottom",
    ("bodies",): "body, objects, particles",
    ("height",): "h",
    ("radius",): "r",
    ("lower",): "min, from, minimum",
    ("upper",): "max, to, maximum",
    # faces by other names
    ("z_min",): "bottom, floor, ground, base, y min, ymin, zmin, z lower",
    ("z_max",): "top, ceiling, lid, y max, ymax, zmax, z upper",
    ("x_min",): "left",
    ("x_max", "r_max"): "right, outer",
    ("r_min",): "axis, centre, center",
    ("r_max",): "x max",
    ("z",): "y",
    ("r",): "x",
}
"""Names of a case, and other words for them, separated by commas."""

NEGATIONS = ("non", "not", "no", "un", "in", "anti", "a")
"""Beginnings that turn a word into its opposite."""


def meant(word: Any, allowed: Iterable[Any]) -> list[Any]:
    """The allowed names that a word may mean; empty if none is similar."""
    if not isinstance(word, str):
        return []
    plain, names = _plain(word), {_plain(str(name)): name for name in allowed}
    if plain in names:
        return [names[plain]]
    known = {synonym: _allowed(synonym, names) for synonym in _TABLE}
    if plain in known:
        return known[plain]
    alike = {synonym: found for synonym, found in known.items() if found and len(synonym) > 3}
    alike |= {name: [names[name]] for name in names}
    for close in difflib.get_close_matches(plain, alike, n=1):
        return [] if _opposite(plain, close) else alike[close]
    return []


def nearest(word: Any, allowed: Iterable[Any]) -> Any | None:
    """The first allowed name that a word may mean."""
    return next(iter(meant(word, allowed)), None)


def _plain(word: str) -> str:
    """A word without case, hyphens and blanks."""
    return re.sub(r"[\s_./-]+", "", word[:LONGEST].casefold())


def _allowed(synonym: str, names: dict[str, Any]) -> list[Any]:
    wanted = dict.fromkeys(_plain(name) for group in _TABLE[synonym] for name in group)
    return [names[name] for name in wanted if name in names]


def _opposite(word: str, name: str) -> bool:
    """Whether a word is a name with a negation before it."""
    return any(
        word.startswith(no) and difflib.SequenceMatcher(None, word[len(no) :], name).ratio() > 0.95
        for no in NEGATIONS
    )


def _table() -> dict[str, list[tuple[str, ...]]]:
    found: dict[str, list[tuple[str, ...]]] = {}
    for names, words in WORDS.items():
        for word in words.split(","):
            found.setdefault(_plain(word), []).append(names)
    return found


_TABLE = _table()
