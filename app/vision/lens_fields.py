"""A Brown-Conrady lens as JSON fields, and the checks of numbers read from outside."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from app.errors import InvalidInput
from app.vision.brown import Brown

LARGEST_SIDE = 1_000_000


def brown_as_dict(lens: Brown) -> dict[str, Any]:
    """Return a lens as JSON-serialisable fields: model, width, height, center, scale, k and p."""
    return {
        "model": "brown",
        "width": lens.width,
        "height": lens.height,
        "center": list(lens.center),
        "scale": lens.scale,
        "k": list(lens.k),
        "p": list(lens.p),
    }


def brown_from_dict(fields: Mapping[str, Any]) -> Brown:
    """Return the lens that `brown_as_dict` gave the fields of; further fields are ignored.

    Raises:
        InvalidInput: If a field is missing or isn't what it should be.
    """
    if fields.get("model") != "brown":
        raise InvalidInput(f"unknown model {fields.get('model')!r}", where="distortion.model", expected="'brown'")
    width, height = (size_from(fields, name) for name in ("width", "height"))
    (scale,) = numbers_from(fields, "scale", 1)
    if scale <= 0:
        raise InvalidInput("not positive", where="distortion.scale", expected="a length in px")
    xc, yc = numbers_from(fields, "center", 2)
    k1, k2, k3 = numbers_from(fields, "k", 3)
    p1, p2 = numbers_from(fields, "p", 2)
    return Brown(width, height, (xc, yc), scale, (k1, k2, k3), (p1, p2))


def size_from(fields: Mapping[str, Any], name: str) -> int:
    """Return an image side in px.

    Raises:
        InvalidInput: If it is missing, no integer or out of range.
    """
    value = fields.get(name)
    if isinstance(value, bool) or not isinstance(value, int) or not 1 <= value <= LARGEST_SIDE:
        raise InvalidInput(
            f"{value!r} is no image side", where=f"distortion.{name}", expected=f"an integer from 1 to {LARGEST_SIDE}"
        )
    return value


def numbers_from(fields: Mapping[str, Any], name: str, count: int, *, none: float | None = None) -> list[float]:
    """Return a field of one number, or of a list of numbers.

    Args:
        fields: Where to look.
        name: Of the field.
        count: How many numbers it holds; for 1 it may stand without a list.
        none: What null stands for; ``None`` if null isn't allowed.

    Raises:
        InvalidInput: If it is missing or isn't that many finite numbers.
    """
    if name in fields and fields[name] is None and none is not None:
        return [none] * count
    value = fields.get(name)
    values: list[Any] = list(value) if isinstance(value, list | tuple) else [value]
    if len(values) != count or not all(_is_number(each) for each in values):
        raise InvalidInput(
            f"{value!r} isn't usable", where=f"distortion.{name}", expected=f"{count} finite number{'s' * (count > 1)}"
        )
    return [float(each) for each in values]


def mapping_from(fields: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    """Return a field that is itself an object of fields.

    Raises:
        InvalidInput: If it is missing or no object.
    """
    value = fields.get(name)
    if not isinstance(value, Mapping):
        raise InvalidInput("missing or no object of fields", where=f"distortion.{name}")
    return value


def finite_or_none(value: float) -> float | None:
    """Return a number for JSON, which has no infinity."""
    return value if math.isfinite(value) else None


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
