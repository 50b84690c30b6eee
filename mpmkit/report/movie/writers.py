"""Files of moving pictures: GIF by Pillow, MP4 by FFmpeg of the package imageio-ffmpeg."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np

from ...errors import CaseError
from ...output.atomic import replacing

COLOURS = 256
"""Colours of a GIF."""
SPARSE = 3
"""Every third row and column is used to choose the colours."""


def write_gif(path: Path, pictures: Sequence[np.ndarray], fps: float) -> None:
    """Write RGB pictures ``(height, width, 3)``, bytes, as a GIF that repeats for ever.

    The GIF format stores the time of a picture in whole hundredths of a second.
    """
    from PIL import Image

    images = [Image.fromarray(picture) for picture in pictures]
    # One palette for all: a palette of its own for each would flicker.
    sample = np.concatenate([picture[::SPARSE, ::SPARSE] for picture in pictures])
    palette = Image.fromarray(sample).quantize(COLOURS, Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
    images = [image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images]
    milliseconds = max(20, 10 * round(100 / fps))  # browsers show faster ones slowly
    with replacing(path) as partial:
        images[0].save(
            partial, "GIF", save_all=True, append_images=images[1:], duration=milliseconds, loop=0, disposal=1
        )


def write_mp4(path: Path, pictures: Sequence[np.ndarray], fps: float) -> None:
    """Write RGB pictures ``(height, width, 3)``, bytes, as H.264 that every browser plays."""
    import imageio_ffmpeg

    height, width = (2 * (side // 2) for side in pictures[0].shape[:2])  # the format halves the colours' grid
    with replacing(path) as partial:
        writer = imageio_ffmpeg.write_frames(
            str(partial), (width, height), fps=fps, macro_block_size=1, output_params=["-f", "mp4"]
        )
        writer.send(None)
        for picture in _held(pictures, fps):
            writer.send(np.ascontiguousarray(picture[:height, :width]))
        writer.close()


def _held(pictures: Sequence[np.ndarray], fps: float) -> Iterator[np.ndarray]:
    """The pictures; the last one is shown for one more second, so that the viewer sees the final state."""
    yield from pictures
    for _ in range(round(fps)):
        yield pictures[-1]


WRITERS = {".gif": write_gif, ".mp4": write_mp4}


def require_writer(path: Path) -> None:
    """Check before drawing that a file with this extension can be written.

    Raises:
        CaseError: it cannot.
    """
    ending = path.suffix.lower()
    if ending not in WRITERS:
        raise CaseError(f"the movie is '{path}'; its name must end in {' or '.join(WRITERS)}")
    if ending == ".mp4":
        try:
            import imageio_ffmpeg  # noqa: F401
        except ImportError:
            raise CaseError(
                f"'{path}' needs the package imageio-ffmpeg: pip install imageio-ffmpeg, or write a .gif"
            ) from None
