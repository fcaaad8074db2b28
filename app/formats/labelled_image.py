"""An image with its segments, as exports take it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from app.formats.labelled import LabelledSegments
from app.formats.reference_camera import ReferenceCamera


@dataclass(frozen=True, eq=False)
class LabelledImage:
    """An image and its segments.

    Attributes:
        name: Path under the root without extension, ``KITTI/000000``.
        file_name: The same with extension, ``KITTI/000000.png``.
        width: In px.
        height: In px.
        labelled: The segments, in the order to write. Without verdicts all count as kept.
        camera: Name of the camera, empty if unknown.
        source: Where the image comes from, empty if unknown.
        sequence: The drive it belongs to, empty if unknown.
        reference: Reference distortion of its camera, if known.
        content: Returns the image file's bytes; ``None`` leaves the image itself out of the export.
    """

    name: str
    file_name: str
    width: int
    height: int
    labelled: LabelledSegments
    camera: str = ""
    source: str = ""
    sequence: str = ""
    reference: ReferenceCamera | None = None
    content: Callable[[], bytes] | None = None
