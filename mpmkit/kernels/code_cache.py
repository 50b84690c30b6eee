"""The cache of compiled code on disk, so that only the first run compiles.

numba's own cache checks only the file of a kernel. If a function in another file that the kernel calls
changes, or a constant with which it was compiled, numba goes on using the old code. Here the name of a file
of compiled code depends on everything that determines the code: the sources of the kernel's package and of
``mpmkit.kernels``, the constants of the kernel and the functions that it calls, from any package
(``fingerprint``), and the types of its arguments. If one of these has no key, each process compiles the
kernel itself.
"""

from __future__ import annotations

import hashlib
import pickle
import re
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import Any

import numba
import numpy as np
from numba.core.caching import NullCache
from numba.core.compiler import CompileResult
from numba.core.dispatcher import Dispatcher
from numba.core.serialize import dumps
from numba.core.sigutils import normalize_signature

from . import code_folders
from .ahead import AHEAD
from .fingerprint import Unknown, fingerprint, signature_key

KERNELS = Path(__file__).parent


def cached_code(compiler: Callable[..., Callable], *arguments: Any, **options: Any) -> Callable:
    """``compiler(*arguments, **options)`` as a decorator that keeps the compiled code on disk."""

    def decorate(python_function: Callable) -> Callable:
        compiled = compiler(*arguments, **options)(python_function)
        if isinstance(compiled, Dispatcher):  # not if compilation is switched off
            compiled._cache = KeptCode(compiled)  # type: ignore[attr-defined]
            compiled.get_call_template = _by_type_alone(compiled)  # type: ignore[method-assign]
        return compiled

    return decorate


def _by_type_alone(function: Dispatcher) -> Callable:
    """Let other compiled code find a function by the types of the arguments, not by their values.

    numba gives each constant argument a type of its own. Without this, it would compile the function, and all
    that it calls, once for each value.
    """
    by_value = function.get_call_template

    def by_type(arguments: Any, named: Any) -> Any:
        types = tuple(numba.types.unliteral(given) for given in arguments)
        return by_value(types, {name: numba.types.unliteral(given) for name, given in named.items()})

    return by_type


class KeptCode(NullCache):
    """The cached code of one function; numba asks it before it compiles, and gives it what it compiled.

    The sources are read when the function is defined, because they may change while a process runs. Constants
    are read when it is compiled, as numba does: a module may set them after it defines the function.
    """

    def __init__(self, function: Dispatcher) -> None:
        self._function = function
        self._package = _package(function.py_func.__module__)
        self.compiled_with: str | None = None
        """Fingerprint of the function when code for it was first asked for"""

    @property
    def cache_path(self) -> str | None:
        """The folder of the cache; numba shows it in ``stats``."""
        root = code_folders.cache_root()
        return None if root is None else str(root / self._package)

    def load_overload(self, sig: Any, target_context: Any) -> CompileResult | None:
        """Load the code for a signature; None if there is none."""
        target_context.refresh()
        with suppress(Exception):  # a value has no key, or a file is damaged: then it is compiled again
            path = self._path(sig, target_context.codegen())
            if path.exists() or AHEAD.compiles(path):
                return CompileResult._rebuild(target_context, *pickle.loads(code_folders.read(path)))
        return None

    def save_overload(self, sig: Any, data: CompileResult) -> None:
        """Write code to the cache, unless it holds an address of this process."""
        if data.library.has_dynamic_globals or not all(part.can_cache for part in data.lifted):
            return
        with suppress(Exception):  # a full disk, or a value without a key
            code_folders.write(self._path(sig, data.codegen), dumps(data._reduce()))

    def path(self, sig: Any, target_context: Any) -> Path:
        """Where code for a signature is kept.

        Raises:
            Unknown: it cannot be kept.
        """
        return self._path(sig, target_context.codegen())

    def _path(self, sig: Any, codegen: Any) -> Path:
        root = code_folders.cache_root()
        if root is None:
            raise Unknown("no folder can be written")
        now = fingerprint(self._function)
        self.compiled_with = self.compiled_with or now
        key = f"{now} {signature_key(normalize_signature(sig)[0])} {codegen.magic_tuple()}"
        python = self._function.py_func
        name = f"{python.__module__}.{python.__qualname__}"
        called = hashlib.sha256(f"{name} {key}".encode()).hexdigest()[:32]
        file = re.sub(r"\W+", "_", name)[-100:]
        return root / self._package / f"{file}.{called}{code_folders.CODE}"


@cache
def _package(module: str) -> str:
    """Name and digest of the package of a module; for mpmkit itself, the digest of its kernels only."""
    top = module.partition(".")[0]
    package = sys.modules.get(top)
    if top == "mpmkit":
        sources = []
    elif getattr(package, "__path__", None) is not None:
        sources = [Path(folder) for folder in package.__path__]  # type: ignore[union-attr]
    else:
        file = getattr(package, "__file__", None)
        sources = [] if file is None else [Path(file)]
    versions = (sys.version, numba.__version__, np.__version__)
    return f"{top}-{digest((KERNELS, *sources), versions)}"


def digest(sources: tuple[Path, ...], versions: tuple[str, ...] = ()) -> str:
    """Digest of the names and contents of these Python files, or of all in these folders.

    It does not depend on where a folder is: another copy of the same sources finds the same code.
    """
    total = hashlib.sha256("\0".join(versions).encode())
    for source in sources:
        root, files = (source, sorted(source.rglob("*.py"))) if source.is_dir() else (source.parent, [source])
        for file in filter(Path.is_file, files):  # the lock file of an editor may be a broken link
            total.update(file.relative_to(root).as_posix().encode() + b"\0" + file.read_bytes())
    return total.hexdigest()[:16]
