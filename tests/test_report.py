"""The report: pictures of fabricated run directories, axisymmetric, 3-D, and of scenes that are no slump."""

from __future__ import annotations

import numpy as np
import pytest
from matplotlib.image import imread

from mpmkit.errors import CaseError
from mpmkit.output import FrameWriter, History, RunDirectory, Variable, read_frames, summarise, write_json
from mpmkit.report import draw_pictures
from mpmkit.report.domain import domain_of
from mpmkit.report.outline import chosen_frames
from mpmkit.report.run_results import read_results
from mpmkit.report.section import plane_of, section_of
from mpmkit.spaces import SPACES

DENSITY, GRAVITY, HEIGHT = 2000.0, 9.81, 0.3
PICTURES = ["outline.png", "spread_and_height.png", "energies.png"]


def stretch(time: float, spread: float) -> tuple[float, float]:
    """Horizontal stretch of a body that spreads, and its rate."""
    growth = spread - 1
    return 1 + growth * (1 - np.exp(-((time / 0.25) ** 2))), growth * 8 * time * np.exp(
        -((time / 0.25) ** 2)
    ) * 4


def cone(space, spacing: float) -> np.ndarray:
    """Abrams' cone filled with points, (n, dim), of which 3-D keeps a quarter."""
    across = np.arange(spacing / 2, 0.1, spacing)
    up = np.arange(spacing / 2, HEIGHT, spacing)
    axes = [across] * (space.dim - 1) + [up]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, space.dim)
    radius = np.linalg.norm(points[:, :-1], axis=1)
    return points[radius < 0.1 - points[:, -1] / 6]


def fabricate(path, space_name: str, *, spread: float = 2.8, until: float = 1.0, spacing: float = 0.01):
    """Write the run directory of a cone that is stretched sideways and flattened, as a slump is."""
    space = SPACES[space_name]
    run = RunDirectory(path)
    run.claim()
    horizontal = {axis: [0.0, 0.5] for axis in space.axes[:-1]}
    case = {
        "name": f"slump-{space_name}",
        "space": space_name,
        "until": until,
        "grid": {
            "cell_size": 2 * spacing,
            "domain": {**horizontal, "z": [0.0, 0.4]},
            "faces": {"z_min": "slip", **{f"{axis}_min": "symmetry" for axis in horizontal}},
        },
        "output": {"snapshot_times": [0.0, 0.1, 0.2, 0.5, 60.0]},
    }
    write_json(run.case, case)
    history = History(
        [
            Variable("spread_diameter", "m", "spread diameter"),
            Variable("height", "m", "largest height"),
            Variable("axis_height", "m", "height on the axis"),
            Variable("slump", "m", "slump"),
            Variable("kinetic_energy", "J", "kinetic energy"),
            Variable("potential_energy", "J", "potential energy"),
            Variable("strain_energy", "J", "elastic strain energy"),
        ],
        {"title": "fabricated"},
        space.axes,
    )
    start = cone(space, spacing)
    mass = DENSITY * 5.5e-3 / len(start)
    frames = FrameWriter(run.frames, space)
    times = np.linspace(0, until, 201)
    for step, time in enumerate(times):
        wide, rate = stretch(time, spread)
        scale = np.array([wide] * (space.dim - 1) + [wide**-2])
        position = start * scale
        velocity = start * np.array([rate] * (space.dim - 1) + [-2 * rate * wide**-3])
        row = {
            "spread_diameter": 0.2 * wide,
            "height": HEIGHT * wide**-2,
            "axis_height": (HEIGHT - 0.02 * time) * wide**-2,
            "slump": HEIGHT * (1 - wide**-2),
            "kinetic_energy": 0.5 * mass * (velocity**2).sum(),
            "potential_energy": mass * GRAVITY * position[:, -1].sum(),
            "strain_energy": 0.0,
        }
        history.record(time, row)
        if step % 10 == 0:
            half_size = spacing / 2 * scale * np.ones_like(start)
            fields = {
                "velocity": velocity,
                "speed": np.linalg.norm(velocity, axis=1),
                "half_size": half_size,
                "body": np.zeros(len(start), dtype=np.int32),
            }
            frames.write(time, step, fields, position)
    history.write(run.history)
    numbers = {"particle_steps": 1000, "particles": len(start), "steps": len(times), "wall_time": 2.0}
    data = history.dataset()
    grows = data.spread_diameter.values
    numbers["t500"] = float(np.interp(0.5, grows, times)) if grows.max() > 0.5 else None
    numbers |= {"at_rest_since": None, "spread_rate": None}
    write_json(run.summary, summarise(data, **numbers, stopped_because="finished", plugins={}))
    return path


@pytest.fixture(scope="module")
def axisymmetric(tmp_path_factory):
    return fabricate(tmp_path_factory.mktemp("axisymmetric") / "run", "axisymmetric")


def assert_pictures(paths, names) -> None:
    assert [path.name for path in paths] == names
    for path in paths:
        picture = imread(path)
        assert min(picture.shape[:2]) > 400
        assert path.stat().st_size > 10_000
        assert 0.02 < (picture[..., :3].min(axis=-1) < 0.98).mean() < 0.9  # neither blank nor full


@pytest.mark.parametrize("space", ["axisymmetric", "3d", "plane-strain"])
def test_a_slump_is_drawn(tmp_path, space):
    run = fabricate(tmp_path / "run", space, spacing=0.02)
    assert_pictures(draw_pictures(run), PICTURES)
    assert sorted(path.name for path in (run / "report").iterdir()) == sorted(PICTURES)


def test_the_report_can_be_made_again_and_matplotlib_keeps_its_settings(axisymmetric):
    import matplotlib

    before = dict(matplotlib.rcParams)
    first = [path.read_bytes() for path in draw_pictures(axisymmetric)]
    assert dict(matplotlib.rcParams) == before
    assert [path.read_bytes() for path in draw_pictures(axisymmetric)] == first


def test_a_scene_that_hardly_moves_is_drawn(tmp_path):
    run = fabricate(tmp_path / "run", "plane-strain", spread=1.02, until=0.3, spacing=0.02)
    assert read_results(run).summary["t500"] is None
    assert_pictures(draw_pictures(run), PICTURES)


def test_without_frames_there_is_no_outline(axisymmetric, tmp_path):
    for name in ("case.json", "history.nc", "summary.json"):
        (tmp_path / name).write_bytes((axisymmetric / name).read_bytes())
    assert_pictures(draw_pictures(tmp_path), PICTURES[1:])


def test_snapshots_are_the_nearest_frames_and_the_end(axisymmetric):
    times = [time for time, _ in chosen_frames(read_results(axisymmetric))]
    assert times == pytest.approx([0.0, 0.1, 0.2, 0.5, 1.0])  # the 60 s of the case are never reached


def test_half_a_body_is_drawn_whole(axisymmetric):
    results = read_results(axisymmetric)
    section = section_of(results.frames[-1][1], results, plane_of(results), domain_of(results))
    assert section.lower[0] == pytest.approx(-section.upper[0])
    assert len(section.centre) == 2 * results.summary["particles"]
    assert domain_of(results).floor == 0.0


def test_a_section_in_3d_holds_the_particles_within_a_cell_of_its_plane(tmp_path):
    run = fabricate(tmp_path / "run", "3d", spacing=0.02)
    results = read_results(run)
    section = section_of(read_frames(run / "frames")[0][1], results, plane_of(results), domain_of(results))
    points = cone(SPACES["3d"], 0.02)
    assert plane_of(results) == 0.0
    assert len(section.centre) == 2 * (points[:, 1] <= 0.04).sum()


def test_a_directory_without_results_is_bad_input(tmp_path):
    with pytest.raises(CaseError, match="does not hold the results of a run"):
        draw_pictures(tmp_path)
