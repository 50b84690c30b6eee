"""How much memory this process can still allocate: limits of the machine, control group and batch job."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from pathlib import Path

import psutil

GROUPS, OWN_GROUPS = Path("/sys/fs/cgroup"), Path("/proc/self/cgroup")
"""Linux files with the limits of control groups, and with the groups of this process."""
MIB = 2**20


def available_memory() -> int:
    """Bytes that can still be allocated."""
    return tightest_limit()[0]


def tightest_limit() -> tuple[int, str]:
    """Bytes that can still be allocated, and the limit behind them in words.

    It is the least of four values: the free memory of the machine; the rest of the limits of the control
    groups (version 1 and 2; containers and most batch systems use them); the rest of the memory that Slurm
    has granted to the job; and the rest of the address space (``ulimit -v``).
    """
    left = [(psutil.virtual_memory().available, "on this machine")]
    left += [(size, "by the limit of its control group") for size in _of_control_groups()]
    left += [(size, "by what Slurm has granted") for size in _of_slurm()]
    left += [(size, "by ulimit -v") for size in _of_address_space()]
    size, limit = min(left, key=lambda one: one[0])
    return max(0, int(size)), limit


def _of_control_groups() -> Iterator[float]:
    """The rest of the limits of this process's group and its parent groups; file cache counts as free."""
    for line in _text(OWN_GROUPS).splitlines():
        _, controllers, path = [*line.split(":", 2), "", ""][:3]
        if controllers == "":
            root, limit, usage, cache = GROUPS, "memory.max", "memory.current", "inactive_file"
        elif "memory" in controllers.split(","):
            root, limit = GROUPS / "memory", "memory.limit_in_bytes"
            usage, cache = "memory.usage_in_bytes", "total_inactive_file"
        else:
            continue
        group = root / path.strip("/")
        for folder in (group, *group.parents):
            if folder.is_relative_to(root) and (most := _text(folder / limit).strip()).isdigit():
                reclaimable = re.search(rf"^{cache} (\d+)$", _text(folder / "memory.stat"), re.MULTILINE)
                used = int(_text(folder / usage).strip() or 0) - int(reclaimable[1] if reclaimable else 0)
                yield int(most) - used


def _of_slurm() -> Iterator[float]:
    """Memory granted by Slurm on this node, minus that of this process; for Slurm, 0 means all memory."""
    cpus = re.match(r"\d+", os.environ.get("SLURM_CPUS_ON_NODE", ""))
    grants = {"SLURM_MEM_PER_NODE": 1, "SLURM_MEM_PER_CPU": int(cpus[0]) if cpus else 1}
    for name, times in grants.items():
        granted = os.environ.get(name, "")
        if granted.isdigit() and int(granted) > 0:
            yield int(granted) * times * MIB - psutil.Process().memory_info().rss


def _of_address_space() -> Iterator[float]:
    try:
        import resource
    except ImportError:  # not available on Windows
        return
    most = resource.getrlimit(resource.RLIMIT_AS)[0]
    if most != resource.RLIM_INFINITY:
        yield most - psutil.Process().memory_info().vms


def _text(file: Path) -> str:
    """The content of a file; empty if there is no file."""
    try:
        return file.read_text(encoding="utf-8")
    except (OSError, ValueError):
        return ""
