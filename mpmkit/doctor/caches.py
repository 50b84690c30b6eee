"""The folders of compiled code, with their size."""

from __future__ import annotations

from pathlib import Path

from .finding import Finding, mebibytes


def caches() -> Finding:
    """Path, size and number of files of the compiled kernels."""
    from ..kernels.code_folders import cache_root

    root = cache_root()
    if root is None:
        return Finding(
            {"compiled kernels": "nowhere"},
            [
                "compiled kernels cannot be kept, since no cache folder can be written: every run compiles "
                "them again, which takes about 20 seconds; set NUMBA_CACHE_DIR to a folder that can be "
                "written"
            ],
        )
    sizes = [path.stat().st_size for path in _files(root)]
    return Finding({"compiled kernels": f"{root}, {mebibytes(sum(sizes))} in {len(sizes)} files"})


def _files(root: Path) -> list[Path]:
    return [path for path in root.rglob("*") if path.is_file()]
