"""Datumaro's own JSON, ``annotations/default.json``, one ``polyline`` per segment.

Datumaro leaves the origin to the data; CVAT, which reads and writes it, counts from the corner of the first pixel, so
0.5 is added to x and y.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from app.formats.exports.polyline import CORNER, LABEL, attributes, dump, polylines
from app.formats.labelled_image import LabelledImage


def export_datumaro(images: Iterable[LabelledImage]) -> Iterator[tuple[str, bytes]]:
    """Yield the images that are given with their content, then one file with all annotations."""
    items: list[str] = []
    for image in images:
        if image.content is not None:
            yield f"images/default/{image.file_name}", image.content()
        items.append(dump(_item(image)))
    labels = {"labels": [{"name": LABEL, "parent": "", "attributes": []}], "attributes": []}
    head = f'"info":{{}},"categories":{dump({"label": labels})}'
    yield "annotations/default.json", f'{{{head},"items":[{",".join(items)}]}}'.encode()


def _item(image: LabelledImage) -> dict[str, Any]:
    lines = zip(polylines(image.labelled, CORNER), attributes(image.labelled), strict=True)
    return {
        "id": image.name,
        "annotations": [
            {
                "id": number,
                "type": "polyline",
                "attributes": known,
                "group": 0,
                "label_id": 0,
                "points": line.ravel().tolist(),
                "z_order": 0,
            }
            for number, (line, known) in enumerate(lines)
        ],
        "attr": {},
        "image": {"path": image.file_name, "size": [image.height, image.width]},
    }
