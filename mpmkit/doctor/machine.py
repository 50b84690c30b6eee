"""The platform and its processor."""

from __future__ import annotations

import os
import platform
import re
from pathlib import Path

from .finding import Finding

CPU_INFO = Path("/proc/cpuinfo")
WIDTHS = {"avx512f": 512, "avx2": 256, "avx": 256, "sse2": 128, "neon": 128}
"""Vector width in bits for each processor feature, the widest first."""


def machine() -> Finding:
    """Operating system, processor, its cores, and the width of its vectors as the compiler sees it."""
    import llvmlite.binding as llvm
    import psutil

    features = llvm.get_host_cpu_features()
    width = next((bits for name, bits in WIDTHS.items() if features.get(name)), None)
    facts = {
        "platform": platform.platform(),
        "processor": _model() or platform.processor() or platform.machine(),
        "compiled for": llvm.get_host_cpu_name(),
        "vector width": "not known" if width is None else f"{width} bits, {width // 64} doubles",
        "cores": f"{psutil.cpu_count(logical=False) or 'unknown'} physical, {os.cpu_count()} logical, "
        f"{_usable()} for this process",
    }
    return Finding(facts)


def _usable() -> int:
    """Logical cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def _model() -> str | None:
    try:
        found = re.search(r"^model name\s*:\s*(.+)$", CPU_INFO.read_text(encoding="utf-8"), re.MULTILINE)
    except (OSError, ValueError):  # not Linux
        return None
    return None if found is None else found[1].strip()
