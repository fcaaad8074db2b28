"""labelme: ``NAME.json`` beside each image, one ``linestrip`` per segment.

labelme's origin is the corner of the first pixel: 0.5 is added to x and y. What is known of a segment stands in its
``description`` as JSON, since labelme's flags are true or false only.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import PurePosixPath
from typing import Any

from app.formats.exports.polyline import CORNER, LABEL, attributes, dump, polylines
from app.formats.labelled_image import LabelledImage


def export_labelme(images: Iterable[LabelledImage]) -> Iterator[tuple[str, bytes]]:
    """Yield, per image, the image if it is given with its content, and its ``NAME.json``."""
    for image in images:
        if image.content is not None:
            yield image.file_name, image.content()
        yield f"{image.name}.json", dump(_document(image)).encode()


def _document(image: LabelledImage) -> dict[str, Any]:
    lines = zip(polylines(image.labelled, CORNER), attributes(image.labelled), strict=True)
    return {
        "version": "5.5.0",
        "flags": {},
        "shapes": [
            {
                "label": LABEL,
                "points": line.tolist(),
                "group_id": None,
                "description": dump(known) if known else "",
                "shape_type": "linestrip",
                "flags": {},
                "mask": None,
            }
            for line, known in lines
        ],
        "imagePath": PurePosixPath(image.file_name).name,
        "imageData": None,
        "imageHeight": image.height,
        "imageWidth": image.width,
    }
