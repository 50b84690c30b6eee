"""Distributions of plug-ins in a process of their own, found there as if they were installed."""

import os
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]


def installed_beside(distribution: Path, place: Path) -> dict[str, str]:
    """An environment in which it is found, as an installer would have it, without asking one."""
    project = tomllib.loads((distribution / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    info = place / f"{project['name'].replace('-', '_')}-{project['version']}.dist-info"
    info.mkdir(parents=True)
    metadata = f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n"
    (info / "METADATA").write_text(metadata, encoding="utf-8")
    points = [f"{name} = {module}" for name, module in project["entry-points"]["mpmkit"].items()]
    (info / "entry_points.txt").write_text("\n".join(["[mpmkit]", *points]), encoding="utf-8")
    before = os.environ.get("PYTHONPATH", "")
    paths = [str(place), str(distribution / "src"), str(ROOT), str(ROOT / "plugins"), before]
    own = {"PYTHONPATH": os.pathsep.join(paths), "MPMKIT_PLUGINS": project["name"], "NUMBA_NUM_THREADS": "1"}
    return {**os.environ, **own}


def passes_its_own_tests(distribution: Path, place: Path) -> str:
    """What pytest said of the tests of a distribution, which must all pass."""
    environment = installed_beside(distribution, place)
    warnings = ["-W", "default::DeprecationWarning", "-W", "error::RuntimeWarning"]
    pytest = [sys.executable, *warnings, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    done = subprocess.run(
        [*pytest, "--noconftest", f"--rootdir={distribution}", "tests"],
        cwd=distribution,
        env=environment,
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout + done.stderr
    assert "failed" not in done.stdout
    return done.stdout
