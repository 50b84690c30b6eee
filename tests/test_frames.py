"""Frames of a run: they are read back exactly, and their list is always complete."""

from __future__ import annotations

import xml.etree.ElementTree as ET

import numpy as np
import pytest

from mpmkit.errors import CaseError, OutputError
from mpmkit.output import FrameWriter, read_frame, read_frames
from mpmkit.spaces import SPACES


class TestFrames:
    @pytest.mark.parametrize("name", SPACES)
    def test_reads_back_exactly(self, tmp_path, name):
        space, rng = SPACES[name], np.random.default_rng(2)
        writer = FrameWriter(tmp_path / "frames", space)
        position = rng.normal(size=(50, space.dim))
        fields = {
            "velocity": rng.normal(size=(50, space.dim)),
            "half_size": rng.normal(size=(50, 3)),
            "speed": rng.normal(size=50),
            "body": np.arange(50, dtype=np.int32),
            "particle": np.arange(50)[::-1],
        }
        writer.write(1 / 3, 12, fields, position)
        [(time, path)] = read_frames(tmp_path / "frames")
        assert time == 1 / 3
        assert path.name == "frame_000012.vtu"
        frame = read_frame(path)
        axes = list(range(space.dim))
        np.testing.assert_array_equal(frame["position"][:, axes], position)
        np.testing.assert_array_equal(frame["velocity"][:, axes], fields["velocity"])
        if space.dim == 2:
            assert not frame["position"][:, 2].any()  # in the plane that a viewer shows
        for scalar in ("half_size", "speed", "body", "particle"):
            np.testing.assert_array_equal(frame[scalar], fields[scalar])
        assert frame["body"].dtype == np.int32

    def test_the_list_names_every_frame(self, tmp_path):
        writer = FrameWriter(tmp_path, SPACES["plane-strain"])
        for step in range(0, 30, 10):
            writer.write(0.1 * step, step, {}, np.zeros((2, 2)))
            listed = {path for _, path in read_frames(tmp_path)}
            assert listed == set(tmp_path.glob("frame_*.vtu"))
        writer.write(2.0, 20, {}, np.ones((2, 2)))  # the same step again: the end of a run on a frame
        assert [time for time, _ in read_frames(tmp_path)] == [0.0, 1.0, 2.0]
        root = ET.parse(tmp_path / "frames.pvd").getroot()
        assert (root.tag, root.attrib["type"]) == ("VTKFile", "Collection")

    def test_starts_afresh(self, tmp_path):
        FrameWriter(tmp_path, SPACES["3d"]).write(0.0, 0, {}, np.zeros((2, 3)))
        (tmp_path / "view.pvsm").write_text("the user's own")
        FrameWriter(tmp_path, SPACES["3d"])
        assert [path.name for path in tmp_path.iterdir()] == ["view.pvsm"]
        assert read_frames(tmp_path) == []

    def test_a_full_disk(self, tmp_path, monkeypatch):
        import meshio

        writer = FrameWriter(tmp_path, SPACES["3d"])
        writer.write(0.0, 0, {}, np.zeros((2, 3)))

        def fill_the_disk(path, mesh, **options):
            path.write_bytes(b"<VTKFile")
            raise OSError(28, "No space left on device")

        monkeypatch.setattr(meshio, "write", fill_the_disk)
        with pytest.raises(OutputError, match="No space left"):
            writer.write(1.0, 1, {}, np.zeros((2, 3)))
        assert sorted(path.name for path in tmp_path.iterdir()) == ["frame_000000.vtu", "frames.pvd"]
        assert len(read_frames(tmp_path)) == 1

    def test_a_list_that_is_not_one(self, tmp_path):
        (tmp_path / "frames.pvd").write_text("<VTKFile><Collection>")
        with pytest.raises(CaseError, match="not a list of frames"):
            read_frames(tmp_path)
