"""Pictures of an evaluation: which image belongs to a name, and the drawing of one."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from app.commands.whole_files import write_whole
from app.errors import InvalidImage, InvalidInput, NotFound, TooLarge
from app.evaluation import draw_overlay
from app.evaluation.overlay import Scored
from app.formats.files import read_file
from app.formats.naming import is_image_path, name_images
from app.images import decode_display
from app.vision.segments import Segments


def find_images(folder: Path) -> dict[str, Path]:
    """Return the images of a folder and its subfolders by name.

    Raises:
        NotFound: If there is no such folder.
        InvalidInput: If there are no images, or two have one name; all of those are named.
    """
    if not folder.is_dir():
        raise NotFound("the image folder doesn't exist", where=str(folder), hint="is the path right?")
    found = [file.relative_to(folder).as_posix() for file in folder.rglob("*") if file.is_file()]
    images = name_images(filter(is_image_path, found))
    if not images:
        raise InvalidInput("there are no images", where=str(folder), hint="leave the images out for scores alone")
    return {name: folder / path for name, path in images.items()}


def write_picture(image: Path, path: Path, labels: Segments, predictions: Segments, score: Scored) -> None:
    """Draw the outcomes on an image and write the picture as PNG.

    Raises:
        InvalidFile: If the image can't be read.
        InvalidImage: If it can't be decoded.
        TooLarge: If it is over the limits.
        OSError: If the picture can't be written.
    """
    picture = draw_overlay(_decoded(image), labels, predictions, score)
    _, encoded = cv2.imencode(".png", picture, [cv2.IMWRITE_PNG_COMPRESSION, 3])
    write_whole(path, encoded.tobytes())


def _decoded(image: Path) -> NDArray[np.uint8]:
    try:
        return decode_display(read_file(image))
    except (InvalidImage, TooLarge) as error:
        raise type(error)(error.message, where=str(image), expected=error.expected, hint=error.hint) from error
