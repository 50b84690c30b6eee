"""The files of a run in its directory: the history, the frames, the summary and the log."""

from .frames import FrameWriter, read_frame, read_frames
from .history import History
from .json_file import write_json
from .log import open_log
from .run_directory import RunDirectory
from .summary import summarise
from .variables import PARTICLE_VARIABLES, Variable
from .wall_frames import Drawn, WallFrameWriter, read_wall_frame, read_wall_frames

__all__ = [
    "PARTICLE_VARIABLES",
    "Drawn",
    "FrameWriter",
    "History",
    "RunDirectory",
    "Variable",
    "WallFrameWriter",
    "open_log",
    "read_frame",
    "read_frames",
    "read_wall_frame",
    "read_wall_frames",
    "summarise",
    "write_json",
]
