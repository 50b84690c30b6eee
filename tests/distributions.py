"""Distributions of plug-ins in a new process, in which they are found as if they were installed."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]


def installed_beside(distributions: list[Path], place: Path) -> dict[str, str]:
    """An environment in which they are found, as an installer would have it, without asking one."""
    names = []
    for distribution in distributions:
        project = tomllib.loads((distribution / "pyproject.toml").read_text(encoding="utf-8"))["project"]
        names.append(project["name"])
        info = place / f"{project['name'].replace('-', '_')}-{project['version']}.dist-info"
        info.mkdir(parents=True)
        metadata = f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n"
        (info / "METADATA").write_text(metadata, encoding="utf-8")
        points = [f"{name} = {module}" for name, module in project["entry-points"]["mpmkit"].items()]
        (info / "entry_points.txt").write_text("\n".join(["[mpmkit]", *points]), encoding="utf-8")
    sources = [str(distribution / "src") for distribution in distributions]
    paths = [str(place), *sources, str(ROOT), str(ROOT / "plugins"), os.environ.get("PYTHONPATH", "")]
    own = {"PYTHONPATH": os.pathsep.join(paths), "MPMKIT_PLUGINS": ",".join(names), "NUMBA_NUM_THREADS": "1"}
    return {**os.environ, **own}


def run_their_tests(distributions: list[Path], place: Path) -> subprocess.CompletedProcess[str]:
    """pytest with the tests of some distributions in one folder; it says of each how it went."""
    environment = installed_beside(distributions, place)
    warnings = ["-W", "default::DeprecationWarning", "-W", "error::RuntimeWarning"]
    pytest = [sys.executable, *warnings, "-m", "pytest", "-v", "-p", "no:cacheprovider", "--noconftest"]
    folder = distributions[0].parent
    return subprocess.run(
        [*pytest, f"--rootdir={folder}", *(f"{each.name}/tests" for each in distributions)],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
    )
