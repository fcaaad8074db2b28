"""COCO instances, ``annotations/instances_default.json``.

COCO knows no open line. A segment becomes a polygon that runs along it and back, so that no tool closes it into a
sliver; its first half, up to the far end, is the segment. Two traps: ``pycocotools`` takes a polygon of four numbers
for a box, so a line of two points gets its middle as a third; and the area is 0, which tools that filter by area drop.
COCO's origin is the corner of the first pixel: 0.5 is added to x and y.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.formats.exports.polyline import CORNER, LABEL, attributes, dump, polylines
from app.formats.labelled_image import LabelledImage


def export_coco(images: Iterable[LabelledImage]) -> Iterator[tuple[str, bytes]]:
    """Yield the images that are given with their content, then one file with all annotations."""
    records: list[str] = []
    annotations: list[str] = []
    for number, image in enumerate(images, start=1):
        if image.content is not None:
            yield f"images/{image.file_name}", image.content()
        size = {"width": image.width, "height": image.height}
        records.append(dump({"id": number, "file_name": image.file_name, **size}))
        lines = polylines(image.labelled, CORNER)
        for line, known in zip(lines, attributes(image.labelled), strict=True):
            annotations.append(dump(_annotation(len(annotations) + 1, number, line, known)))
    categories = dump([{"id": 1, "name": LABEL, "supercategory": ""}])
    text = f'{{"images":[{",".join(records)}],"categories":{categories},"annotations":[{",".join(annotations)}]}}'
    yield "annotations/instances_default.json", text.encode()


def ring(line: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the polygon ``(2 n - 2, 2)`` along a line and back, n >= 3: a line of two points gets its middle."""
    if len(line) == 2:
        line = np.stack([line[0], line.mean(axis=0), line[1]])
    return np.concatenate([line, line[-2:0:-1]])


def _annotation(number: int, image: int, line: NDArray[np.float64], known: dict[str, Any]) -> dict[str, Any]:
    low, high = line.min(axis=0), line.max(axis=0)
    return {
        "id": number,
        "image_id": image,
        "category_id": 1,
        "segmentation": [ring(line).ravel().tolist()],
        "bbox": np.round([*low, *(high - low)], 6).tolist(),
        "area": 0.0,
        "iscrowd": 0,
        "attributes": known,
    }
