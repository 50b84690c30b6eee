"""``mpmkit.fit``: from measurements to parameters."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from concurrent.futures import Executor
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from ..errors import CaseError
from ..study.execute import Listener
from ..study.processes import cores, processes
from .load import load_fit, parse_fit
from .measurements import measured_in
from .model import Alternative, Fit
from .plausible import check
from .runs import Purse, Runs, Spent, Test
from .stages import base_of, case_of, check_path, stages_of


def fit(
    fit: Fit | Mapping[str, Any] | str | Path,
    out: str | Path | None = None,
    *,
    overwrite: bool = False,
    threads: int | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    listen: Listener | None = None,
):
    """Find the parameters of cases from measurements.

    The fit minimises χ² = (y − d)ᵀ C⁻¹ (y − d), first with coarse models and then with finer ones. Parallel
    runs give the derivatives. The intervals come from the profile likelihood on a surface through the runs
    of the finest model (docs/fit.md).

    Args:
        fit: a fit file, its content, or a ``Fit``.
        out: directory for results and runs; a fit continues from the runs there. Default: nothing is written.
        overwrite: whether the result of another fit in ``out`` may be replaced; its runs are always kept.
        threads: of each run; default: as the fit says.
        workers: runs at once on this machine; default: as many as its cores hold of ``threads``.
        executor: of ``concurrent.futures``, runs them instead of processes of this machine.
        listen: called with each run that has ended, and its result.

    Returns:
        A ``FitResult``: ``parameters`` by path with ``value``, ``low``, ``high``, ``level`` and
        ``identifiable``, ``correlation``, ``sentences``, ``further``, ``evidence`` (laws compared) and
        ``dataset`` (all runs).

    Raises:
        CaseError: bad input, a measurement that no run can give, or SciPy is not installed.
        GuardStop: a guard stopped a run that the fit needs.
        OutputError: the directory cannot be written.
    """
    require_scipy()
    from .directory import PAGE, FitDirectory

    wanted = fit if isinstance(fit, Fit) else load_fit(fit) if isinstance(fit, str | Path) else parse_fit(fit)
    candidates = prepared(wanted)
    threads = threads or wanted.threads
    with ExitStack() as stack:
        if out is None:
            out = stack.enter_context(tempfile.TemporaryDirectory(prefix="mpmkit-fit-")) + "/fit"
            kept = False
        else:
            kept = True
        directory = FitDirectory(Path(out), overwrite)
        stack.enter_context(directory.claimed(wanted))
        if executor is None:
            executor = stack.enter_context(processes(workers or max(1, cores() // threads), False))
        page = PAGE if kept and wanted.pages else None
        result = _fitted(wanted, candidates, directory.store, threads, executor, listen, page)
        if kept:
            directory.write(result)
        else:
            _read_all(result)
    return result


def prepared(fit: Fit) -> dict[str, tuple[Alternative, list[Test]]]:
    """What is fitted, by law, the law of the cases first; all input is checked here, before the first run.

    Raises:
        CaseError: one sentence that names the place in the fit file.
    """
    own = Alternative(parameters=fit.parameters)
    found: dict[str, tuple[Alternative, list[Test]]] = {}
    for name, alternative in {"": own, **fit.laws}.items():
        tests = []
        for test, entry in fit.tests.items():
            base = base_of(test, entry)
            measured = measured_in(test, entry, case_of(test, entry, base, alternative.changes))
            stages = stages_of(test, entry, base, alternative.changes, measured)
            check(test, stages[-1].case, measured)
            tests.append(Test(test, stages, measured))
        for path, parameter in alternative.parameters.items():
            for one in tests:
                for stage in one.stages:
                    check_path(stage, path, fit.tests[one.name].changes | alternative.changes)
                for end in ("low", "high"):
                    _require_valid(one, path, end, getattr(parameter, end))
        if not name:
            name = _law(tests[0])
        if name in found:
            raise CaseError(f"laws.{name} has the name of the law of the cases; call it something else")
        found[name] = (alternative, tests)
    return found


def _require_valid(test: Test, path: str, end: str, value: float) -> None:
    """Refuse bounds that are not valid in the case."""
    try:
        test.stages[-1].member({path: value})
    except CaseError as error:
        sentence = str(error).removeprefix(f"{test.stages[-1].where}: ")
        raise CaseError(f"parameters.{path}.{end}: {sentence}") from None


def _law(test: Test) -> str:
    """Name of the law of the cases, with which the others are compared."""
    return test.stages[-1].case.bodies[0].material.law


def _fitted(
    fit: Fit,
    candidates,
    store,
    threads: int,
    executor: Executor,
    listen: Listener | None,
    page: str | None,
):
    from .coordinates import Coordinates
    from .flow_curve import flow_curves
    from .model_error import known_errors
    from .result import FitResult
    from .solve import solve

    purse, solutions = Purse(fit.budget), {}
    for name, (alternative, tests) in candidates.items():
        runs = Runs(tests, store, threads, purse, executor, listen, page)
        solutions[name] = solve(
            runs, Coordinates(alternative.parameters), known_errors(fit, tests), fit.level
        )
    try:
        curves = flow_curves(next(iter(solutions.values())), fit.level)
    except Spent:
        curves = []
    return FitResult(fit, solutions, curves)


def _read_all(result) -> None:
    """Read what is needed from the directory while it exists."""
    _ = result.dataset, result.further, result.sentences, result.as_json()


def require_scipy() -> None:
    """Refuse to begin without SciPy.

    Raises:
        CaseError: it is not installed; the sentence says how to install it.
    """
    try:
        import scipy.optimize  # noqa: F401
    except ImportError:
        raise CaseError(
            "mpmkit fit needs scipy: pip install scipy, or pip install '.[fit]' in a clone of mpmkit"
        ) from None
