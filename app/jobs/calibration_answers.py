"""What a worker makes of a finished calibration for whoever asks: pictures, the difference to a reference, exports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from app.calibration.comparison import Difference, ReferenceLens, compare
from app.calibration.exports import FORMATS, Exported, Intrinsics, choose_intrinsics, export_lens, overview
from app.calibration.lens import CameraLens
from app.formats.reference_camera import ReferenceCamera
from app.images import decode_eight_bit
from app.images.browser import encode
from app.jobs.tasks import errors_that_travel
from app.vision.undistorted_view import undistorted_view

QUALITY = 90
"""Of the JPEG: it is looked at, never measured on."""


@dataclass(frozen=True)
class Focal:
    """Focal length and principal point, px; ``None`` where they aren't known."""

    focal_length: float | None = None
    principal_point: tuple[float, float] | None = None


def undistorted_task(content: bytes, name: str, lens: Mapping[str, Any], max_pixels: int) -> bytes:
    """Return an image with the lens taken out as JPEG of the same size, black where the image doesn't reach.

    Args:
        content: The image file.
        name: Of the image, for messages.
        lens: ``CameraLens.as_dict``.
        max_pixels: Greatest number of pixels that is decoded.

    Raises:
        ClearLinesError: Always one of the tree, with the reason.
    """
    with errors_that_travel(name, "taking the lens out"):
        pixels = decode_eight_bit(content, max_pixels=max_pixels)
        return jpeg(undistorted_view(CameraLens.from_dict(lens)).render(pixels))


def difference_task(lens: Mapping[str, Any], reference: ReferenceCamera) -> dict[str, Any]:
    """Return how far a lens is from a reference, as ``Difference.as_dict`` gives it.

    Raises:
        ClearLinesError: Always one of the tree, with the reason.
    """
    with errors_that_travel("reference", "the comparison"):
        return difference_to(CameraLens.from_dict(lens), reference).as_dict()


def overview_task(result: Mapping[str, Any], camera_name: str, given: Focal) -> dict[str, Any]:
    """Return for each export format whether, and how exactly, it holds a calibration's lens.

    Args:
        result: ``Calibration.as_dict``.
        camera_name: Files are named by it.
        given: By a person.

    Raises:
        ClearLinesError: Always one of the tree, with the reason.
    """
    with errors_that_travel("exports", "the conversion"):
        intrinsics = intrinsics_of(result, given)
        options = overview(CameraLens.from_dict(result["lens"]), intrinsics, calibration=result)
        return {
            "intrinsics": {
                "focal_length": intrinsics.focal_length,
                "principal_point": intrinsics.principal_point,
                "source": intrinsics.source,
            },
            "formats": [
                {**option.as_dict(), "file_name": FORMATS[option.format].file_name(camera_name)} for option in options
            ],
        }


def export_task(result: Mapping[str, Any], file_format: str, camera_name: str, given: Focal) -> Exported:
    """Return a calibration's lens as a file of another tool.

    Raises:
        InvalidInput: If there is no such format.
        CannotExport: If the format can't hold the lens.
        ClearLinesError: Always one of the tree, with the reason.
    """
    with errors_that_travel("exports", "the conversion"):
        lens, intrinsics = CameraLens.from_dict(result["lens"]), intrinsics_of(result, given)
        return export_lens(lens, file_format, camera_name=camera_name, intrinsics=intrinsics, calibration=result)


def intrinsics_of(result: Mapping[str, Any], given: Focal) -> Intrinsics:
    """Return the best intrinsics that are known: what a person gave, what vanishing points told, or nominal ones."""
    told = result.get("focal") or {}
    point = told.get("principal_point")
    estimate = Focal(told.get("focal_length"), None if point is None else (point[0], point[1]))
    return choose_intrinsics(
        CameraLens.from_dict(result["lens"]),
        focal_length=given.focal_length,
        principal_point=given.principal_point,
        estimate=estimate,
    )


def difference_to(lens: CameraLens, reference: ReferenceCamera) -> Difference:
    """Return how far a lens is from a reference."""
    return compare(lens, ReferenceLens(reference.matrix, reference.distortion), lens.width, lens.height)


def jpeg(pixels: NDArray[np.uint8]) -> bytes:
    """Return pixels as the bytes of a JPEG file."""
    return encode(".jpg", pixels, [cv2.IMWRITE_JPEG_QUALITY, QUALITY])
