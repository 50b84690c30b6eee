"""Folders of compiled code: their names, and which ones are deleted."""

from __future__ import annotations

import os
import time
from collections import Counter

import numba
import pytest

from mpmkit.kernels import code_folders
from mpmkit.kernels.code_cache import cached_code, digest
from mpmkit.kernels.code_folders import FOLDER, IN_USE, KEPT, MARKER, TAG, VERSIONS, forget_generations, write


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "inner").mkdir()
    for name in ("a.py", "b.py", "inner/c.py"):
        (tmp_path / name).write_text(f"NAME = {name!r}\n")
    (tmp_path / "notes.txt").write_text("nothing that is compiled\n")
    return tmp_path


@pytest.mark.parametrize("name", ["a.py", "b.py", "inner/c.py"])
def test_the_digest_changes_with_every_source(folder, name):
    before = digest((folder,))
    text = (folder / name).read_text()
    (folder / name).write_text(text + "FACTOR = 2.0\n")
    assert digest((folder,)) != before
    (folder / name).write_text(text)
    assert digest((folder,)) == before


def test_the_digest_changes_with_files_that_come_go_or_are_renamed(folder):
    found = {digest((folder,))}
    (folder / "d.py").write_text("")
    found.add(digest((folder,)))
    (folder / "d.py").rename(folder / "e.py")
    found.add(digest((folder,)))
    (folder / "a.py").unlink()
    found.add(digest((folder,)))
    assert len(found) == 4


def test_the_digest_is_of_sources_and_versions_alone(folder):
    before = digest((folder,), ("3.11", "0.60"))
    (folder / "notes.txt").write_text("something else\n")
    os.utime(folder / "a.py", (1, 1))
    assert digest((folder,), ("3.11", "0.60")) == before
    assert digest((folder,), ("3.11", "0.61")) != before
    assert digest((folder / "a.py",)) != digest((folder / "b.py",))


def generations(root, ages, name="plug", marker=TAG):
    """Folders of compiled code last used so many seconds ago."""
    for i, age in enumerate(ages):
        path = root / f"{name}-{i:016x}"
        path.mkdir()
        (path / "kernel.key.code").write_bytes(b"code")
        if marker is not None:
            (path / MARKER).write_text(marker)
        os.utime(path, (time.time() - age,) * 2)


def left(root):
    return {path.name for path in root.iterdir()}


def test_old_generations_are_forgotten_but_for_the_last_few(tmp_path):
    generations(tmp_path, [IN_USE + 60 * i for i in reversed(range(1, KEPT + 4))])
    forget_generations(tmp_path, "plug")
    assert left(tmp_path) == {f"plug-{i:016x}" for i in range(3, KEPT + 3)}


def test_generations_that_a_run_may_be_using_are_kept(tmp_path):
    generations(tmp_path, [60 * i for i in range(KEPT + 3)] + [IN_USE + 60, IN_USE - 60])
    forget_generations(tmp_path, "plug")
    assert left(tmp_path) == {f"plug-{i:016x}" for i in range(KEPT + 5) if i != KEPT + 3}


def test_generations_of_other_packages_are_left_alone(tmp_path):
    for name in ("plug", "plug-in", "plugs"):
        generations(tmp_path, [2 * IN_USE] * (KEPT + 2), name)
    forget_generations(tmp_path, "plug")
    names = Counter(name.rpartition("-")[0] for name in left(tmp_path))
    assert names == {"plug": KEPT, "plug-in": KEPT + 2, "plugs": KEPT + 2}


@pytest.mark.parametrize("marker", [None, TAG.replace("mpmkit", "another program")])
def test_a_folder_without_our_marker_is_left_alone(tmp_path, marker):
    generations(tmp_path, [2 * IN_USE] * (KEPT + 3), marker=marker)
    forget_generations(tmp_path, "plug")
    assert len(left(tmp_path)) == KEPT + 3


def test_what_a_user_put_into_an_old_generation_stays(tmp_path):
    generations(tmp_path, [2 * IN_USE] * KEPT + [3 * IN_USE])
    old = tmp_path / f"plug-{KEPT:016x}"
    (old / "notes.txt").write_text("of the user's")
    os.utime(old, (time.time() - 3 * IN_USE,) * 2)
    forget_generations(tmp_path, "plug")
    assert left(old) == {"notes.txt", MARKER}


def test_what_is_compiled_for_ever_new_constants_is_forgotten(tmp_path):
    """A constant that is another one in every process must not fill the disk."""
    generation = tmp_path / "plug-0123456789abcdef"
    write(generation / "other.key.code", b"code")
    write(generation / ".kernel.77.code.partial", b"of a process that was killed")
    for i in range(VERSIONS + 5):
        write(generation / f"kernel.{i}.code", b"code")
        os.utime(generation / f"kernel.{i}.code", (time.time() - 2 * IN_USE + i,) * 2)
    os.utime(generation / ".kernel.77.code.partial", (time.time() - 2 * IN_USE,) * 2)
    write(generation / "kernel.last.code", b"code")
    kept = {f"kernel.{i}.code" for i in range(6, VERSIONS + 5)}
    assert left(generation) == {MARKER, "other.key.code", "kernel.last.code"} | kept


def test_a_place_that_cannot_be_written_is_no_place(tmp_path, monkeypatch):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "file"))
    assert code_folders.cache_root.__wrapped__() is None
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path / "new" / "folder"))
    assert code_folders.cache_root.__wrapped__() == tmp_path / "new" / "folder" / FOLDER


def twice(x):
    return 2 * x


def test_without_a_place_code_is_compiled_and_not_kept(monkeypatch):
    monkeypatch.setattr(code_folders, "cache_root", lambda: None)
    compiled = cached_code(numba.njit)(twice)
    assert compiled(21) == 42
    assert compiled.stats.cache_path is None


def test_a_damaged_file_and_a_full_disk_cost_time_and_no_more(monkeypatch, tmp_path):
    monkeypatch.setattr(code_folders, "cache_root", lambda: tmp_path)
    assert cached_code(numba.njit)(twice)(21) == 42
    (file,) = tmp_path.rglob("*.code")
    file.write_bytes(file.read_bytes()[:100])
    again = cached_code(numba.njit)(twice)
    assert again(21) == 42
    assert not again.stats.cache_hits

    def full(path, content):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(code_folders, "write", full)
    assert cached_code(numba.njit)(twice)(21.5) == 43.0
