"""Fluids at rest: hydrostatic pressure from the first step on, in one layer and in several."""

from __future__ import annotations

import math

import numpy as np
import pytest
from bands import below, close_to

import mpmkit
from mpmkit.solver.particle_fields import mean_pressure

pytestmark = pytest.mark.section(4)

G, HEIGHT, WIDTH, DX = 9.81, 0.3, 0.075, 0.015
WATER = {"law": "newtonian", "density": 1000.0, "viscosity": 1.0, "sound_speed": {"factor": 10}}
CONCRETE = {
    "law": "herschel-bulkley-evp",
    "density": 2574.0,
    "yield_stress": 188.91,
    "consistency": 45.65,
    "flow_index": 1.33,
    "sound_speed": {"factor": 10},
}
SIDES = {"plane-strain": "x", "axisymmetric": "r", "3d": "xy"}


def tank(space, layers, dx=DX, side="slip", floor="slip", width=WIDTH, **case):
    """Layers of (material, top) that fill a tank from wall to wall."""
    axes, bottom, bodies = SIDES[space] + "z", 0.0, []
    for material, top in layers:
        shape = {
            "kind": "box",
            "lower": [*[0.0] * len(SIDES[space]), bottom],
            "upper": [*[width] * len(SIDES[space]), top],
        }
        bodies.append({"shape": shape, "material": material})
        bottom = top
    faces = {f"{axis}_{end}": side for axis in SIDES[space] for end in ("min", "max")} | {"z_min": floor}
    faces.pop("r_min", None)
    domain = {axis: [0.0, width] for axis in SIDES[space]} | {"z": [0.0, bottom + 4 * dx]}
    return mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": space,
                "until": 10.0,
                "grid": {"cell_size": dx, "domain": {axis: domain[axis] for axis in axes}, "faces": faces},
                "bodies": bodies,
                **case,
            }
        )
    )


def swing(simulation, exact, seconds):
    """Largest error of the pressure away from surface and floor, over the largest pressure; and largest
    speed, m/s."""
    p, dx = simulation.particles, simulation.grid.cell_size
    worst = fastest = 0.0
    while simulation.time < seconds:
        simulation.advance()
        z = p.position[:, -1]
        inside = (z > dx) & (z < HEIGHT - dx)
        off = mean_pressure(p)[inside] - exact(z)[inside]
        worst = max(worst, float(np.abs(off).max()) / exact(0.0))
        fastest = max(fastest, float(np.abs(p.velocity).max()))
    return worst, fastest / math.sqrt(2 * G * HEIGHT)


@pytest.mark.parametrize("material", [WATER, CONCRETE], ids=lambda m: m["law"])
@pytest.mark.parametrize("space", SIDES)
def test_column_at_rest_has_its_pressure_at_every_moment(validate, space, material):
    """p = ρ g (H - z) ± 2 % from the start, and not only when oscillations have died out.

    The pressure of a column that starts without it oscillates between 0 and 2 ρ g H, with a period of 4 H/c =
    50 ms.
    """
    dx = 0.025 if space == "3d" else DX
    simulation = tank(space, [(material, HEIGHT)], dx)
    worst, fastest = swing(simulation, lambda z: material["density"] * G * (HEIGHT - z), 0.12)
    name = f"{material['law']} in a tank, {space}, all the time"
    validate(f"{name}: pressure, error over ρ g H", worst, below(0.02, "0"))
    validate(f"{name}: speed over that of free fall", fastest, below(2e-3, "0"))


@pytest.mark.parametrize("heavy_below", [True, False])
def test_two_layers_at_rest(validate, heavy_below):
    """p is continuous across the interface, and its slope is ρ g of each layer.

    Either layer may be the lower one. With the heavy layer on top the rest is unstable, but nothing has
    disturbed it yet.
    """
    density = [2000.0, 1000.0] if heavy_below else [1000.0, 2000.0]
    half = HEIGHT / 2
    simulation = tank(
        "plane-strain", [(WATER | {"density": d}, half * (k + 1)) for k, d in enumerate(density)]
    )

    def exact(z):
        lower = density[1] * half + density[0] * (half - z)
        return G * np.where(z < half, lower, density[1] * (HEIGHT - z))

    worst, fastest = swing(simulation, exact, 0.1)
    name = f"Two layers at rest, the heavy one {'below' if heavy_below else 'above'}"
    validate(f"{name}: pressure, error over the largest", worst, below(0.02, "0"))
    validate(f"{name}: speed over that of free fall", fastest, below(5e-3, "0"))


def test_film_rests_on_its_slope_from_the_start(validate):
    """Across the slope a film is at rest while it flows along the slope: p = ρ g_n (H - z) from the start."""
    along, across = G * math.sin(0.3), G * math.cos(0.3)
    water, gravity = WATER | {"viscosity": 100.0}, [along, -across]
    simulation = tank("plane-strain", [(water, HEIGHT)], side="periodic", floor="stick", gravity=gravity)
    p = simulation.particles
    for _ in range(200):
        simulation.advance()
        exact = 1000.0 * across * (HEIGHT - p.position[:, 1])
        inside = (p.position[:, 1] > DX) & (p.position[:, 1] < HEIGHT - DX)
        off = np.abs(mean_pressure(p) - exact)[inside].max() / (1000.0 * across * HEIGHT)
        assert off < 0.02
    validate("Film on a slope, at once: pressure, error over ρ g H", off, below(0.02, "0"))
    mean = float(p.mass @ p.velocity[:, 0] / p.mass.sum())
    assert mean > 0.5 * along * simulation.time  # it flows all the same


MADE = {
    "open side": {"faces": {"x_max": "open"}},
    "no floor": {"faces": {"z_min": "open"}},
    "narrower than the tank": {"upper": [0.045, HEIGHT]},
    "above the floor": {"lower": [0.0, 0.03]},
    "falling": {"velocity": [0.0, -0.1]},
    "gravity askew": {"gravity": [1.0, -9.0]},
    "solid": {
        "material": {"law": "neo-hookean", "density": 1e3, "youngs_modulus": 1e5, "poisson_ratio": 0.3}
    },
}


@pytest.mark.parametrize("change", MADE.values(), ids=MADE)
def test_what_does_not_rest_begins_without_pressure(change):
    body = {
        "shape": {
            "kind": "box",
            "lower": change.get("lower", [0.0, 0.0]),
            "upper": change.get("upper", [WIDTH, HEIGHT]),
        },
        "material": change.get("material", WATER),
        "velocity": change.get("velocity", [0.0, 0.0]),
    }
    faces = {"x_min": "slip", "x_max": "slip", "z_min": "slip"} | change.get("faces", {})
    case = {
        "space": "plane-strain",
        "until": 1.0,
        "gravity": change.get("gravity", [0.0, -G]),
        "grid": {"cell_size": DX, "domain": {"x": [0.0, WIDTH], "z": [0.0, 0.45]}, "faces": faces},
        "bodies": [body],
    }
    p = mpmkit.Simulation(mpmkit.parse_case(case)).particles
    assert (p.volume_ratio == 1).all()
    assert (p.pressure == 0).all()


def open_column(material, width, **case):
    """One half of a column with an open side, on a slip floor."""
    return mpmkit.Simulation(
        mpmkit.parse_case(
            {
                "space": "plane-strain",
                "until": 1.0,
                "grid": {
                    "cell_size": 0.03,
                    "domain": {"x": [0.0, 1.8], "z": [0.0, 0.36]},
                    "faces": {"x_min": "symmetry", "z_min": "slip"},
                },
                "bodies": [
                    {
                        "shape": {"kind": "box", "lower": [0, 0], "upper": [width, HEIGHT]},
                        "material": material,
                    }
                ],
                **case,
            }
        )
    )


@pytest.mark.parametrize("material", [WATER, CONCRETE], ids=["water", "concrete"])
def test_what_begins_without_pressure_says_how_it_swings_and_does(material):
    """First mode of a column: no pressure at first, nearly twice that of its weight after half of 4 H/c."""
    simulation = open_column(material, 0.6)
    (said,) = (sentence for sentence in simulation.remarks() if "begins without pressure" in sentence)
    p, sound = simulation.particles, simulation.particles.groups[0].sound_speed
    period = 4 * HEIGHT / sound
    assert f"a period of about 4 h/c = {period:.2g} s, to the end ({1 / period:.0f} periods, 1 s)" in said
    times, part = [], []
    while simulation.time < period:
        simulation.advance()
        foot = (p.position[:, 0] < 0.03) & (p.position[:, 1] > 0.03) & (p.position[:, 1] < 0.09)
        weight = material["density"] * G * (HEIGHT - p.position[foot, 1])
        times.append(simulation.time)
        part.append(float((mean_pressure(p)[foot] / weight).mean()))
    assert abs(part[0]) < 0.01
    assert times[int(np.argmax(part))] == pytest.approx(period / 2, rel=0.05)
    assert 1.6 < max(part) < 2.1


def test_the_warning_gives_the_time_in_which_viscosity_damps_the_oscillation():
    """6 ρ h²/(π² mu) = 0.27 s for 200 Pa s: six periods of 0.049 s."""
    (said,) = (
        s for s in open_column(WATER | {"viscosity": 200.0}, 0.6).remarks() if "gravity acts suddenly" in s
    )
    assert "until viscosity has damped it, at the earliest (6 periods, 0.27 s)" in said
    for quiet in (
        tank("plane-strain", [(WATER, HEIGHT)]),
        open_column(WATER | {"sound_speed": 24.0}, 0.6, gravity=[0.0, 0.0]),
        open_column(MADE["solid"]["material"], 0.6),
    ):
        assert not any("gravity acts suddenly" in sentence for sentence in quiet.remarks())


# --- Turning over ---------------------------------------------------------------------------------------


def overturning(heavy_below, seconds):
    """Amplitude of the interface's first mode, m, and the energies, while two layers slosh or turn over.

    Started with the velocity of the first mode of a tank of width L, k = π/L, both layers as deep as h:
    w ~ cos(k x) sinh(k (h - |z - h|))/sinh(k h) at the interface.
    """
    width, half = 0.2, HEIGHT / 2
    k = math.pi / width
    density = [2000.0, 1000.0] if heavy_below else [1000.0, 2000.0]
    layers = [(WATER | {"density": d, "viscosity": 0.05}, half * (n + 1)) for n, d in enumerate(density)]
    scheme = {"order": "musl", "velocity": "apic", "time_step": {"fraction": 0.8}}
    simulation = tank("plane-strain", layers, 0.0125, width=width, scheme=scheme)
    p = simulation.particles
    x, z = p.position.T
    away = half - np.abs(z - half)
    mode_w = np.cos(k * x) * np.sinh(k * away) / math.sinh(k * half)
    mode_u = np.sign(z - half) * np.sin(k * x) * np.cosh(k * away) / math.sinh(k * half)
    p.velocity[:, 0], p.velocity[:, 1] = 0.02 * mode_u, 0.02 * mode_w
    number = np.argsort(p.number)
    start = p.position[number].copy()
    near = np.abs(start[:, 1] - half) < 0.0125
    times, heights, potential, total = [], [], [], []
    while simulation.time < seconds:
        simulation.advance()
        moved = (p.position[np.argsort(p.number)] - start)[near, 1]
        shape = np.cos(k * start[near, 0])
        found = simulation.measures(p)
        times.append(simulation.time)
        heights.append(float(moved @ shape / (shape @ shape)))
        potential.append(found["potential_energy"])
        total.append(sum(found[n] for n in ("kinetic_energy", "potential_energy", "compressive_energy")))
    rate = math.sqrt(G * k * math.tanh(k * half) / 3)  # g k (ρ2 - ρ1)/(ρ1 + ρ2) tanh(k h)
    return np.array(times), np.array(heights), np.array(potential), np.array(total), rate


def test_heavy_above_light_turns_over(validate):
    """Rayleigh-Taylor: the interface grows, not faster than σ² = A g k tanh(k h), and energy goes down."""
    times, heights, potential, total, rate = overturning(heavy_below=False, seconds=0.35)
    exact = heights[0] / times[0] / rate * np.sinh(rate * times)
    late = times > 0.15
    found = np.polyfit(times[late], np.log(heights[late]), 1)[0]
    bound = rate / math.tanh(rate * times[late].mean())  # of sinh
    validate("Heavy above light: growth of the interface, over the inviscid one", heights[-1] / exact[-1],
             close_to(0.8, abs=0.22))  # fmt: skip
    validate("Heavy above light: growth rate over the bound", found / bound,
             below(1.02, "≤ 1"))  # fmt: skip
    assert found > 0.5 * rate
    assert potential[-1] < potential[0]
    validate("Heavy above light: largest gain of energy, of that at the start", total.max() / total[0] - 1,
             below(1e-4, "0"))  # fmt: skip


def test_light_above_heavy_does_not(validate):
    """The interface oscillates about its level: at a speed of 20 mm/s by no more than that speed over ω."""
    _, heights, _, total, omega = overturning(heavy_below=True, seconds=0.35)
    validate("Light above heavy: interface, over speed/ω", np.abs(heights).max() / (0.02 / omega),
             below(1.02, "≤ 1"))  # fmt: skip
    assert heights[-1] < heights.max()  # it is on its way back
    assert total.max() < total[0] * (1 + 1e-4)
