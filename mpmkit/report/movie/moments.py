"""The frames that a movie shows: evenly spaced in time, so that the flow has its true speed."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from ...case.ending import latest
from ...errors import CaseError
from ..run_results import RunResults

LEAST = 2
"""Least number of frames of a movie."""


def shown_frames(results: RunResults, directory: Path) -> list[tuple[float, Path]]:
    """Times, s, and files of the frames to show.

    A run also has frames at the snapshot times of its report, which lie between the others: if they were
    shown, the movie would stop for a moment at each of them.

    Raises:
        CaseError: there are too few; the sentence names the key by which a run gets more.
    """
    frames = results.frames
    if len(frames) < LEAST:
        until = latest(results.case["until"])
        there = "no frames" if not frames else "only one frame"
        raise CaseError(
            f"the run in '{directory}' has {there}, and a movie needs at least {LEAST}: run it again with a "
            f"shorter output.frame_interval, such as --set output.frame_interval={until / 100:.3g}"
        )
    times = np.array([time for time, _ in frames])
    # Snapshots make some gaps shorter, and a rounded step others longer: the median is the interval.
    wanted = np.arange(times[0], times[-1], float(np.median(np.diff(times))))
    chosen = {int(np.argmin(np.abs(times - time))) for time in wanted} | {len(times) - 1}
    return [frames[index] for index in sorted(chosen)]
