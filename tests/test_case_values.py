"""Case files: every bad value gives one sentence with the field, the value and what is allowed."""

import pytest
from case_sentences import ABSENT, GOOD, MATERIAL, SHAPE, changed, sentence

from mpmkit.case import parse_case
from mpmkit.solver.scene import make_particles

BAD = [
    # keys
    ("untill", 1, "the case has an unknown key 'untill'; did you mean 'until'?"),
    ("bogus", 1, "unknown key 'bogus'; it may have name, description, space, until,"),
    ("grid.cellsize", 0.1, "grid has an unknown key 'cellsize'; did you mean 'cell_size'?"),
    ("grid.faces.z_mni", "slip", "are x_min, x_max, z_min, z_max; did you mean 'z_min'?"),
    ("grid.faces.floor", "slip", "the faces of the space 'plane-strain' are x_min, x_max, z_min, z_max"),
    ("grid.domain.Z", [0, 1], "has the axes x, z; did you mean 'z'?"),
    ("bodies.0.shap", {}, "bodies.0 has an unknown key 'shap'; did you mean 'shape'?"),
    (f"{SHAPE}.lowr", [0, 0], "bodies.0.shape has an unknown key 'lowr'; did you mean 'lower'?"),
    (f"{MATERIAL}.densty", 1, "bodies.0.material has an unknown key 'densty'; did you mean 'density'?"),
    (f"{MATERIAL}.flow_index", 1, "unknown key 'flow_index'; it may have law, density, sound_speed,"),
    (
        f"{MATERIAL}.sound_speed",
        {"facto": 1},
        "sound_speed has an unknown key 'facto'; did you mean 'factor'?",
    ),
    ("scheme.shap", "linear", "scheme has an unknown key 'shap'; did you mean 'shape'?"),
    ("scheme.shape", {"name": "cpgimp", "domian": "stretch"}, "unknown key 'domian'; did you mean 'domain'?"),
    ("scheme.time_step.frac", 0.2, "scheme.time_step has an unknown key 'frac'; did you mean 'fraction'?"),
    ("output.histroy_interval", 1, "unknown key 'histroy_interval'; did you mean 'history_interval'?"),
    ("line\nbreak", 1, "unknown key 'line break'"),
    (
        MATERIAL,
        {"law": "bingham-evp", "density": 1, "sound_speed": 1, "yield_stress": 1, "plastic_viscosity": 1}
        | {"shear_modulus": 1e308},
        "bodies.0.material makes waves of",
    ),
    # missing
    ("until", ABSENT, "until is missing; it must be a number above 0, in s"),
    (
        "grid",
        ABSENT,
        "it must be an object with the keys 'cell_size' and 'domain', and optionally the key 'faces'",
    ),
    ("bodies", ABSENT, "bodies is missing; it must be a list of one or more objects"),
    (
        f"{SHAPE}.kind",
        ABSENT,
        'shape.kind is missing; it must be "box", "cylinder", "frustum", "mesh", "polygon" or "sphere"',
    ),
    (f"{MATERIAL}.law", ABSENT, 'material.law is missing; it must be "bingham", "'),
    (f"{MATERIAL}.density", ABSENT, "density is missing; it must be a number above 0, in kg/m^3"),
    (f"{MATERIAL}.sound_speed", ABSENT, "sound_speed is missing; the law 'bingham' needs it, in m/s"),
    ("grid.domain.z", ABSENT, "grid.domain lacks the axis 'z'; it needs x, z, each as [lower, upper]"),
    # types
    (f"{MATERIAL}.density", "2000", 'density is "2000"; it must be a number above 0, in kg/m^3'),
    (f"{MATERIAL}.density", True, "density is true; it must be a number above 0, in kg/m^3"),
    (f"{MATERIAL}.density", None, "density is null; it must be a number above 0"),
    ("bodies", {}, "bodies is {}; it must be a list of objects"),
    ("bodies", [], "bodies is []; it must be a list of one or more objects"),
    (
        "bodies.0",
        3,
        "bodies.0 is 3; it must be an object with the keys 'shape' and 'material', and optionally",
    ),
    (SHAPE, "box", "bodies.0.shape.lower is missing; it must be a list of 2 to 3 numbers, in m"),
    (f"{SHAPE}.lower", [0.2, "a"], 'bodies.0.shape.lower.1 is "a"; it must be a number, in m'),
    (
        "bodies.0.particles_per_cell",
        2.5,
        "is 2.5; it must be a whole number above 0 and at most 1000, or a list",
    ),
    ("bodies.0.particles_per_cell", [2, 0], "particles_per_cell.1 is 0; it must be a whole number above 0"),
    (
        "bodies.0.velocity",
        1,
        "velocity is 1; it must be a list of numbers, in m/s, or an object with the keys",
    ),
    (
        "grid.faces.z_min",
        3,
        'z_min is 3; it must be "slip", "stick", "periodic", "open" or "symmetry", or an object',
    ),
    (
        "scheme.time_step",
        1e-5,
        "scheme.time_step is 1e-05; it must be an object that may have the keys 'fraction' and 'ignore'",
    ),
    ("scheme.time_step.ignore", "viscous", 'it must be a list of "acoustic", "viscous" or "advective"'),
    ("output.report", "yes", 'output.report is "yes"; it must be true or false'),
    # values
    ("until", -1, "until is -1; it must be a number above 0, in s"),
    ("until", 10**399, "it must be finite"),
    ("space", "2d", 'space is "2d"; it must be "3d", "plane-strain" or "axisymmetric"'),
    ("grid.cell_size", 0, "grid.cell_size is 0; it must be a number above 0, in m"),
    (
        "grid.cell_size",
        1e-300,
        "grid.domain.x has 1e+300 cells of 1e-300 m; at most 1,073,741,824 are possible",
    ),
    ("grid.domain.x", [1, 0], "grid.domain.x is [1, 0]; the lower end must be below the upper one"),
    ("grid.domain.x", [-1.7e308, 1.7e308], "grid.domain.x has inf cells"),
    ("grid.domain.y", [0, 1], "grid.domain has an axis 'y'; the space 'plane-strain' has the axes x, z"),
    (
        "grid.faces.z_min",
        "friction",
        'or "symmetry"; did you mean {"kind": "friction", "coefficient": …}?',
    ),
    ("grid.faces.z_min", "slipp", '"open" or "symmetry"; did you mean "slip"?'),
    (
        "grid.faces.z_min",
        {"kind": "friction", "coefficient": -1},
        "coefficient is -1; it must be a number of at least 0",
    ),
    ("grid.faces.x_min", "periodic", "x_min and x_max must both be 'periodic' if one of them is"),
    ("gravity", [0], "gravity is [0.0]; in the space 'plane-strain' it needs 2 numbers, along x, z"),
    (
        "gravity",
        [0, 0],
        "sound_speed is a factor of √(2 g h), but gravity is [0.0, 0.0]; give the speed itself, in m/s",
    ),
    (
        "name",
        "../x",
        "name is \"../x\"; it must be at most 100 letters, digits, '_', '.' and '-', first a letter",
    ),
    (f"{SHAPE}.upper", [0.6, 2], "reaches z = 2 m, outside the grid, whose domain along z is [0, 1] m"),
    (f"{SHAPE}.lower", [-0.6, 0], "only a face with 'symmetry' may cut a body"),
    (
        f"{SHAPE}.lower",
        [0.7, 0.1],
        "bodies.0.shape: upper is [0.6, 0.4], but it must be above lower, [0.7, 0.1]",
    ),
    (
        SHAPE,
        {"kind": "box", "lower": [0.51, 0.51], "upper": [0.52, 0.52]},
        "holds no particle at a cell size of 0.1 m",
    ),
    (
        "bodies.0.particles_per_cell",
        5,
        "particles_per_cell is 5; one number must be a square (1, 4, 9, 16, …)",
    ),
    ("scheme.time_step.fraction", 2, "fraction is 2; it must be a number above 0 and at most 1"),
    ("scheme.time_step.ignore", ["viscous", "acoustic"], "it must not contain 'acoustic'"),
    ("output.frame_interval", 1e-9, "output.frame_interval is 1e-09 s; it must be at least 1e-06 s"),
    # plug-ins
    (f"{MATERIAL}.law", "bingam", '.law is "bingam"; it must be "bingham", "'),
    (f"{MATERIAL}.law", ["bingham"], '.law is ["bingham"]; it must be "bingham", "'),
    (
        "scheme.shape",
        "cpgim",
        'scheme.shape is "cpgim"; it must be "cpgimp" or "linear"; did you mean "cpgimp"?',
    ),
    (
        "scheme.shape",
        3,
        'scheme.shape is 3; it must be "cpgimp" or "linear", or an object with such a \'name\'',
    ),
    ("scheme.shape", None, "scheme.shape is null; it must be"),
    ("scheme.shape", [], "scheme.shape is []; it must be"),
    ("scheme.shape", {}, 'scheme.shape.name is missing; it must be "cpgimp" or "linear"'),
    ("scheme.order", "USL", 'scheme.order is "USL"; it must be "musl", "usf" or "usl"; did you mean "usl"?'),
    (
        "scheme.shape",
        {"name": "cpgimp", "domain": "strech"},
        '"strech"; it must be "strain", "fixed", "stretch" or "volume"',
    ),
    (
        f"{MATERIAL}.equation_of_state",
        {"name": "linear", "foo": 1},
        "equation_of_state has an unknown key 'foo'",
    ),
]


RADIAL = {
    "space": "axisymmetric",
    "grid": {"cell_size": 0.1, "domain": {"r": [0, 1], "z": [0, 1]}, "faces": {"z_min": "slip"}},
}


@pytest.mark.parametrize(
    ("path", "value", "expected"), BAD, ids=[f"{path}-{k}" for k, (path, *_) in enumerate(BAD)]
)
def test_a_bad_value_has_its_sentence(path, value, expected):
    def prepare():
        make_particles(parse_case(changed(path, value)))

    assert expected in sentence(prepare)


@pytest.mark.parametrize("faces", [{"r_max": "periodic"}, {"r_min": "periodic", "r_max": "periodic"}])
def test_the_radial_axis_has_no_period(faces):
    data = GOOD | RADIAL | {"grid": RADIAL["grid"] | {"faces": faces}}
    assert f'grid.faces.{next(iter(faces))} is "periodic"; the radial axis has no' in sentence(
        parse_case, data
    )


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
def test_a_value_that_only_python_allows_is_refused_with_its_place(value):
    expected = f"{value} is not a number that a case can have"
    assert f"until: {expected}" in sentence(parse_case, changed("until", value))
    assert f"bodies.0.shape.lower.1: {expected}" in sentence(
        parse_case, changed(f"{SHAPE}.lower", [0, value])
    )


ANYTHING = (None, True, -7, "nonsense", [], {}, [None], {"name": None}, {"kind": {}}, [[]])
SCENE = "until space gravity grid grid.cell_size grid.domain grid.domain.x grid.faces grid.faces.z_min bodies"
BODY = "shape shape.kind shape.lower velocity material material.law material.density material.sound_speed"
REST = (
    "scheme scheme.shape scheme.order scheme.time_step scheme.time_step.ignore output output.snapshot_times "
    "output.report output.particle_history name description bodies.0 bodies.0.material.equation_of_state"
)
PLACES = [*SCENE.split(), *(f"bodies.0.{place}" for place in BODY.split()), *REST.split()]
MAY_BE = {
    "gravity": [None],
    "grid.faces": [{}],
    "bodies.0.velocity": [None],
    "scheme": [{}],
    "scheme.time_step": [{}],
    "scheme.time_step.ignore": [[]],
    "output": [{}],
    "output.snapshot_times": [[]],
    "output.report": [True],
    "output.particle_history": [[]],
    "name": ["nonsense"],
    "description": ["nonsense"],
}


@pytest.mark.parametrize("place", PLACES)
def test_any_wrong_value_at_any_place_gives_one_sentence(place):
    for value in ANYTHING:
        if value in MAY_BE.get(place, []):
            parse_case(changed(place, value))
        else:
            assert place.split(".")[0] in sentence(parse_case, changed(place, value))


def test_more_errors_are_counted_not_listed():
    data = changed("until", -1) | {"space": "2d"}
    text = sentence(parse_case, data)
    assert text.endswith("(and 1 more)")


def test_a_key_missing_because_of_a_misspelling_is_not_counted():
    data = changed("grid.cellsize", 0.1)
    del data["grid"]["cell_size"]
    assert sentence(parse_case, data).endswith("did you mean 'cell_size'?")
