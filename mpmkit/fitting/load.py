"""Reading fit files, with the same checks as for case files."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..case.load import count_from, name_from, read_json, validated
from .model import Fit


def load_fit(path: str | Path) -> Fit:
    """Read and validate a fit file; relative paths of its cases and CSV files start from its folder.

    Raises:
        CaseError: the fit cannot be read or is not valid.
    """
    data = read_json(path, "fit")
    if isinstance(data, dict):
        data.setdefault("name", name_from(path))
        _count_from(Path(path).parent, data)
    return parse_fit(data, source=str(path))


def parse_fit(data: Any, source: str = "fit") -> Fit:
    """Validate a fit given as the content of a JSON file; see ``load_fit``."""
    return validated(Fit, data, source, "fit")


def _count_from(folder: Path, data: dict[str, Any]) -> None:
    """Make the relative paths of cases, meshes and curves start from the folder of the fit file."""
    tests = data.get("tests")
    for test in tests.values() if isinstance(tests, dict) else []:
        if not isinstance(test, dict):
            continue
        if isinstance(test.get("case"), str):
            test["case"] = str(folder / test["case"])
        elif isinstance(test.get("case"), dict):
            count_from(folder, test["case"])
        measurements = test.get("measurements")
        for measurement in measurements if isinstance(measurements, list) else []:
            if isinstance(measurement, dict) and isinstance(measurement.get("file"), str):
                measurement["file"] = str(folder / measurement["file"])
