"""The images of a calibration: which to look at, and their lines before and after the lens is taken out."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.calibration.lens import CameraLens
from app.db.models import Calibration, Image, Segment
from app.errors import Conflict, NotFound
from app.services.calibration_lines import lines_of
from app.services.calibrations import images_of_calibration
from app.services.carrying import stored_polyline
from app.services.images import get_image
from app.vision.undistorted_view import UndistortedView, undistorted_view

MOST_POINTS = 33
"""Points of a line as it is drawn: a lens bends it so smoothly that more aren't seen."""


@dataclass(frozen=True)
class CalibrationImage:
    """An image that a calibration read.

    Attributes:
        image_id: Its id.
        name: As it is named now; as it was named then where it is gone.
        segments: Lines read.
        inliers: Those of them that are straight.
        rms: Of their distances from straight, px.
        left_out_shift: How far the lens moves without this image, px RMS over the frame.
        is_there: Whether it is an image of the camera still.
    """

    image_id: int
    name: str
    segments: int
    inliers: int
    rms: float | None
    left_out_shift: float | None
    is_there: bool


@dataclass(frozen=True)
class ViewedLine:
    """A line as it was measured and with the lens taken out, at most `MOST_POINTS` points each, px."""

    segment_id: int
    rms: float
    probability: float
    measured: list[list[float]]
    undistorted: list[list[float]]


@dataclass(frozen=True)
class ViewedLines:
    """The lines of one image in the image and in the undistorted picture of the same size.

    Attributes:
        scale: px of the picture per px of the corrected image.
        offset: Place of the corrected image's origin in the picture, px.
    """

    image_id: int
    width: int
    height: int
    scale: float
    offset: tuple[float, float]
    lines: tuple[ViewedLine, ...]


def images_of_result(session: Session, row: Calibration) -> list[CalibrationImage]:
    """Return the images of a finished calibration, those with the most straight lines first.

    They are at most `app.services.calibration_inputs.MOST_IMAGES`.
    """
    ids = images_of_calibration(row)
    names: dict[int, str] = dict(
        session.execute(
            select(Image.id, Image.name).where(
                Image.id.in_(ids), Image.camera_id == row.camera_id, Image.deleted_at.is_(None)
            )
        ).all()
    )
    entries = _result(row)["images"]
    images = [
        CalibrationImage(
            image_id=image_id,
            name=names.get(image_id) or entry["name"],
            segments=entry["segments"],
            inliers=entry["inliers"],
            rms=entry["rms"],
            left_out_shift=entry["left_out_shift"],
            is_there=image_id in names,
        )
        for image_id, entry in zip(ids, entries, strict=True)
    ]
    return sorted(images, key=lambda image: (-image.is_there, -image.inliers, image.name))


def image_for(session: Session, row: Calibration, image_id: int) -> Image:
    """Return an image that a calibration's lens is for, read by it or not.

    Raises:
        NotFound: When there is none of this camera.
    """
    image = get_image(session, image_id)
    if image.camera_id != row.camera_id:
        raise NotFound(
            f"image {image_id} isn't of this calibration's camera",
            where=image.name,
            hint="the camera's images are in the list of images",
        )
    return image


def image_to_show(session: Session, row: Calibration) -> Image | None:
    """Return the image of a calibration that is best suited to look at; ``None`` where all are gone."""
    best = next((entry for entry in images_of_result(session, row) if entry.is_there), None)
    return None if best is None else session.get(Image, best.image_id)


def view_of(row: Calibration) -> UndistortedView:
    """Return how a finished calibration shows an image without distortion.

    Raises:
        Conflict: When its lens folds within the frame.
    """
    lens = lens_of(row)
    if not lens.is_invertible():
        raise Conflict("the lens folds within the frame", where="lens", hint="keep more lines near the image's edges")
    return undistorted_view(lens)


def lens_of(row: Calibration) -> CameraLens:
    """Return the lens of a finished calibration."""
    return CameraLens.from_dict(_result(row)["lens"])


def viewed_lines(session: Session, row: Calibration, image: Image) -> ViewedLines:
    """Return a calibration's lines in an image, before and after; those whose segment is gone are left out.

    Raises:
        Conflict: When the lens folds within the frame.
    """
    view = view_of(row)
    lines = lines_of(row)
    own = np.flatnonzero(lines.image_id == image.id)
    ids = lines.segment_id[own].tolist()
    stored: dict[int, bytes] = dict(
        session.execute(select(Segment.id, Segment.points).where(Segment.id.in_(ids))).all()
    )
    shown = tuple(
        _viewed(view, segment_id, stored[segment_id], float(lines.rms[index]), float(lines.probability[index]))
        for index, segment_id in zip(own, ids, strict=True)
        if segment_id in stored
    )
    return ViewedLines(image.id, image.width, image.height, view.scale, view.offset, shown)


def _viewed(view: UndistortedView, segment_id: int, points: bytes, rms: float, probability: float) -> ViewedLine:
    measured = _thinned(stored_polyline(points).astype(np.float64))
    return ViewedLine(segment_id, rms, probability, _listed(measured), _listed(view.project(measured)))


def _thinned(points: NDArray[np.float64]) -> NDArray[np.float64]:
    return points[np.unique(np.linspace(0, len(points) - 1, MOST_POINTS).round().astype(int))]


def _listed(points: NDArray[Any]) -> list[list[float]]:
    """Round to hundredths of a pixel, which is finer than any screen."""
    return np.round(np.nan_to_num(points.astype(np.float64), nan=-1.0), 2).tolist()


def _result(row: Calibration) -> Mapping[str, Any]:
    return row.result or {}
