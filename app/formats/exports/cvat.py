"""CVAT for images 1.1: ``annotations.xml`` with one ``polyline`` per segment.

CVAT's origin is the corner of the first pixel: 0.5 is added to x and y. The label with its attributes is declared in
the file; a CVAT task needs a label of the same name and attributes to take them.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any
from xml.etree import ElementTree

from app.formats.exports.polyline import CORNER, LABEL, attributes, polylines
from app.formats.labelled import ORIGINS
from app.formats.labelled_image import LabelledImage
from app.verdicts import VERDICTS

NOT_XML = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that XML 1.0 can't hold, section 2.2."""
ATTRIBUTES = {
    "verdict": ("select", "\n".join(VERDICTS), "undecided"),
    "score": ("text", "", ""),
    "straightness": ("text", "", ""),
    "origin": ("select", "\n".join(ORIGINS), "import"),
    "id": ("text", "", ""),
}


def export_cvat(images: Iterable[LabelledImage]) -> Iterator[tuple[str, bytes]]:
    """Yield the images that are given with their content, then ``annotations.xml``."""
    parts: list[bytes] = []
    for number, image in enumerate(images):
        if image.content is not None:
            yield f"images/{image.file_name}", image.content()
        parts.append(ElementTree.tostring(_image(number, image), encoding="utf-8"))
    head = b'<?xml version="1.0" encoding="utf-8"?>\n<annotations>\n<version>1.1</version>\n'
    meta = ElementTree.tostring(_meta(len(parts)), encoding="utf-8")
    yield "annotations.xml", b"\n".join([head + meta, *parts, b"</annotations>\n"])


def _meta(count: int) -> ElementTree.Element:
    meta = ElementTree.Element("meta")
    task = ElementTree.SubElement(meta, "task")
    for tag, text in (("name", "ClearLines"), ("size", str(count)), ("mode", "annotation")):
        ElementTree.SubElement(task, tag).text = text
    label = ElementTree.SubElement(ElementTree.SubElement(task, "labels"), "label")
    ElementTree.SubElement(label, "name").text = LABEL
    ElementTree.SubElement(label, "type").text = "polyline"
    declared = ElementTree.SubElement(label, "attributes")
    for name, (kind, values, default) in ATTRIBUTES.items():
        attribute = ElementTree.SubElement(declared, "attribute")
        fields = {"name": name, "mutable": "False", "input_type": kind, "default_value": default, "values": values}
        for tag, text in fields.items():
            ElementTree.SubElement(attribute, tag).text = text
    return meta


def _image(number: int, image: LabelledImage) -> ElementTree.Element:
    size = {"width": str(image.width), "height": str(image.height)}
    element = ElementTree.Element("image", {"id": str(number), "name": _text(image.file_name), **size})
    for line, known in zip(polylines(image.labelled, CORNER), attributes(image.labelled), strict=True):
        shape = ElementTree.SubElement(
            element,
            "polyline",
            {
                "label": LABEL,
                "source": "manual" if known.get("origin") == "manual" else "auto",
                "occluded": "0",
                "points": ";".join(f"{x!r},{y!r}" for x, y in line.tolist()),
                "z_order": "0",
            },
        )
        for name, value in known.items():
            ElementTree.SubElement(shape, "attribute", {"name": name}).text = _text(value)
    return element


def _text(value: Any) -> str:
    return NOT_XML.sub("\ufffd", str(value))
