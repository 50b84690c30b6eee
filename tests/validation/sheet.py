"""The sheet on which a validation test writes what it measured.

A test asks for the fixture ``validate`` and calls it once for every number that it vouches for:

    validate("speed of the plug", flow.plug_speed(), close_to(0.28125, rel=0.02), unit="m/s")

The number is compared with its band there and then, and the test fails at its end if any was missed, so that
the others are measured all the same. Curves go into a figure:

    figure = validate.figure("film", "Film on 20°", x="u (mm/s)", y="z (mm)")
    figure.reference("exact", u, z)
    figure.points("10 cells", speed, height)

Nothing else happens in an ordinary run. Where ``MPMKIT_VALIDATION_RECORDS`` names a folder, as it does when
``docs/validation.py`` runs the tests, each sheet is also kept there as a JSON file, rewritten at every row.
"""

from __future__ import annotations

import hashlib
import json
import os
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from bands import Band

import mpmkit

FOLDER, RESUME = "MPMKIT_VALIDATION_RECORDS", "MPMKIT_VALIDATION_RESUME"


def file_of(test: str) -> Path | None:
    """File of the sheet of a test; None if sheets are not kept."""
    folder = os.environ.get(FOLDER)
    digest = hashlib.sha1(test.encode(), usedforsecurity=False).hexdigest()[:16]
    return Path(folder) / f"{digest}.json" if folder else None


def done_before(test: str) -> bool:
    """Whether a run that is to be resumed has brought this test to an end."""
    path = file_of(test)
    if not os.environ.get(RESUME) or path is None or not path.exists():
        return False
    return json.loads(path.read_text(encoding="utf-8"))["status"] != "running"


@dataclass(frozen=True)
class Row:
    """One line of the report."""

    section: int
    test: str
    expected: str
    obtained: str
    band: str
    holds: bool
    used: float | None = None
    """How close to the edge of the band it is, by which rows of the same name are ranked."""


@dataclass
class Series:
    label: str
    x: list[float]
    y: list[float]
    style: str


@dataclass
class Curves:
    """What one test adds to a figure; tests that name the same figure share it."""

    name: str
    title: str
    x: str
    y: str
    section: int
    scale: str = "linear"
    caption: str = ""
    series: list[Series] = field(default_factory=list)

    def line(self, label: str, x: Any, y: Any) -> None:
        self._add(label, x, y, "line")

    def points(self, label: str, x: Any, y: Any) -> None:
        self._add(label, x, y, "points")

    def reference(self, label: str, x: Any, y: Any) -> None:
        """The exact or independent solution."""
        self._add(label, x, y, "reference")

    def measured(self, label: str, x: Any, y: Any) -> None:
        """Points of an experiment."""
        self._add(label, x, y, "measured")

    def _add(self, label: str, x: Any, y: Any, style: str) -> None:
        x, y = (np.asarray(values, dtype=float).tolist() for values in (x, y))
        self.series.append(Series(label, x, y, style))


class Sheet:
    """Everything that one test measured."""

    def __init__(self, test: str, line: int, section: int, slow: bool) -> None:
        self.test, self.line, self.section, self.slow = test, line, section, slow
        self.version = mpmkit.__version__
        self.began = time.time()
        self.rows: list[Row] = []
        self.curves: list[Curves] = []
        self.status, self.message, self.seconds = "running", "", 0.0
        self.keep()

    def __call__(
        self, test: str, obtained: float, band: Band, *, unit: str = "", section: int | None = None
    ) -> bool:
        """Record a number and whether its band holds it."""
        value = float(obtained)
        used, suffix = band.used(value), f" {unit}" if unit else ""
        return self._record(
            Row(
                self.section if section is None else section,
                test,
                band.expected + suffix,
                band.show(value) + suffix,
                band.text,
                band.holds(value),
                float(used) if np.isfinite(used) else None,
            )
        )

    def states(self, test: str, *, expected: str, obtained: str, holds: Any, band: str = "") -> bool:
        """Record something that is not a number."""
        return self._record(Row(self.section, test, expected, obtained, band, bool(holds)))

    def _record(self, row: Row) -> bool:
        self.rows.append(row)
        self.keep()
        return row.holds

    def figure(self, name: str, title: str, *, x: str, y: str, scale: str = "linear", caption: str = ""):
        """Begin a figure, ``docs/images/validation/<name>.png``, or add to that of another test."""
        curves = Curves(name, title, x, y, self.section, scale, caption)
        self.curves.append(curves)
        return curves

    def judge(self) -> None:
        """Fail the test if a band was missed."""
        missed = [row for row in self.rows if not row.holds]
        lines = [f"{r.test}: {r.obtained}, expected {r.expected} ({r.band})" for r in missed]
        assert not missed, "outside the band:\n  " + "\n  ".join(lines)

    def finish(self, status: str, message: str, seconds: float) -> None:
        self.status, self.message, self.seconds = status, message, seconds
        self.keep()

    def keep(self) -> None:
        """Write the sheet to its file, if one was asked for."""
        path = file_of(self.test)
        if path is not None:
            path.parent.mkdir(parents=True, exist_ok=True)
            content = {name: value for name, value in vars(self).items() if name not in ("rows", "curves")}
            content |= {name: [asdict(one) for one in getattr(self, name)] for name in ("rows", "curves")}
            partial = path.with_suffix(".partial")
            partial.write_text(json.dumps(content), encoding="utf-8")
            partial.replace(path)
