"""Lensfun's XML, which darktable, RawTherapee, digiKam and GIMP correct photos with (Lensfun 0.3)."""

from __future__ import annotations

import math
from xml.etree.ElementTree import Comment, Element, SubElement, indent, tostring

from app.calibration.exports.draft import Draft
from app.calibration.exports.lensfun_fit import POLY5, PTLENS, unit_length
from app.calibration.exports.names import file_stem
from app.vision.frame import center_of

FULL_FRAME_DIAGONAL = math.hypot(36, 24)
"""mm, of the film that crop factor 1 stands for."""
NAMES = {POLY5: ("k1", "k2"), PTLENS: ("a", "b", "c")}


def write_lensfun(draft: Draft) -> bytes:
    """Write a database of one camera with one fixed lens; focal length as on 35 mm film, with crop factor 1."""
    width, height = draft.lens.width, draft.lens.height
    focal_length = draft.intrinsics.focal_length * FULL_FRAME_DIAGONAL / math.hypot(width, height)
    root = Element("lensdatabase", version="1")
    notes = (*draft.lines, f"In mm for crop factor 1, the sensor's size being unknown: {focal_length:.4f}.")
    for note in notes:
        # two hyphens would end the comment
        root.append(Comment(f" {note.replace('--', '––')} "))
    mount = f"clearlines_{file_stem(draft.camera_name)}"

    camera = SubElement(root, "camera")
    _texts(camera, maker="ClearLines", model=draft.name, mount=mount, cropfactor="1")

    lens = SubElement(root, "lens")
    _texts(lens, maker="ClearLines", model=f"{draft.name} lens", mount=mount)
    SubElement(lens, "focal", value=f"{focal_length:.4f}")
    _center(lens, draft)
    # of the outermost pixels' centres, as Lensfun measures images, so that its unit is exactly half the shorter side
    longer, shorter = max(width, height) - 1, min(width, height) - 1
    _texts(lens, **{"type": "rectilinear", "cropfactor": "1", "aspect-ratio": f"{longer / shorter:.9f}"})
    distortion = {"model": draft.conversion.model, "focal": f"{focal_length:.4f}"}
    for name, value in zip(NAMES[draft.conversion.model], draft.conversion.coefficients, strict=True):
        distortion[name] = f"{value:.9g}"
    SubElement(SubElement(lens, "calibration"), "distortion", distortion)
    indent(root, "    ")
    return tostring(root, "utf-8", xml_declaration=True) + b"\n"


def _center(lens: Element, draft: Draft) -> None:
    unit = unit_length(draft.lens.width, draft.lens.height)
    middle = center_of(draft.lens.width, draft.lens.height)
    x, y = ((own - other) / unit for own, other in zip(draft.lens.center, middle, strict=True))
    if max(abs(x), abs(y)) > 1e-9:  # Lensfun reads the element, its schema doesn't know it
        SubElement(lens, "center", x=f"{x:.9g}", y=f"{y:.9g}")


def _texts(parent: Element, **fields: str) -> None:
    for name, text in fields.items():
        SubElement(parent, name).text = text
