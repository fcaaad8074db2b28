"""The report's tables as rows of texts."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from app.calibration.calibration import Calibration
from app.calibration.exports.conversion import Conversion
from app.calibration.exports.export import ExportOption
from app.calibration.report.words import FAMILY_NAMES, MEANINGS, figure, pixels, tiny_pixels, with_sigma

OPENCV_NAMES = ("k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6", "s1", "s2", "s3", "s4", "τx", "τy")
WORST_LINES = 8
NAME_LENGTH = 64
STRAIGHT = 0.5


class ParameterRow(NamedTuple):
    """A parameter of the lens."""

    name: str
    meaning: str
    value: str
    sigma: str


class LadderRow(NamedTuple):
    """A model that was tried."""

    family: str
    released: str
    pred: str
    accepted: bool
    chosen: bool
    reason: str


class LineRow(NamedTuple):
    """A line that fits badly."""

    image: str
    segment: int
    rms: str
    maximum: str
    length: str
    probability: str


class ExportRow(NamedTuple):
    """A format that the lens can or can't be written in."""

    title: str
    model: str
    rms: str
    maximum: str
    allowed: bool
    reason: str


def parameter_rows(calibration: Calibration) -> list[ParameterRow]:
    """Return the parameters for lengths in half diagonals; what wasn't estimated is said to be held."""
    sigma = calibration.sigma
    rows: list[ParameterRow] = []
    for name, value in zip(calibration.lens.names, calibration.lens.parameters, strict=True):
        if name in sigma:
            rows.append(ParameterRow(name, MEANINGS[name], *with_sigma(value, sigma[name])))
        else:
            rows.append(ParameterRow(name, MEANINGS[name], f"{value:g}", "held"))
    return rows


def opencv_rows(conversion: Conversion) -> list[tuple[str, str]]:
    """Return OpenCV's coefficients in the order that its D has."""
    names = OPENCV_NAMES[: len(conversion.coefficients)]
    return [(name, figure(value, 7)) for name, value in zip(names, conversion.coefficients, strict=True)]


def ladder_rows(calibration: Calibration) -> list[LadderRow]:
    """Return the models that were tried, those of the chosen family first, as the calibration has them."""
    chosen = (calibration.lens.family, calibration.released)
    return [
        LadderRow(
            FAMILY_NAMES.get(rung.family, rung.family),
            " ".join(rung.released) or "none",
            pixels(rung.pred),
            rung.accepted,
            rung.accepted and (rung.family, rung.released) == chosen,
            rung.reason,
        )
        for rung in calibration.ladder
    ]


def worst_lines(calibration: Calibration) -> list[LineRow]:
    """Return those lines that count as straight and yet lie farthest from straight, worst first."""
    found = [
        (float(lines.rms[row]), image.name, row, lines)
        for image, lines in zip(calibration.images, calibration.lines, strict=False)
        for row in range(len(lines.segment))
        if lines.probability[row] >= STRAIGHT
    ]
    found.sort(key=lambda each: -each[0])
    return [
        LineRow(
            name if len(name) <= NAME_LENGTH else f"…{name[-NAME_LENGTH + 1 :]}",
            int(lines.segment[row]),
            pixels(rms),
            pixels(float(lines.maximum[row])),
            f"{lines.length[row]:.0f} px",
            f"{lines.probability[row]:.2f}",
        )
        for rms, name, row, lines in found[:WORST_LINES]
    ]


def export_rows(options: Sequence[ExportOption]) -> list[ExportRow]:
    """Return for each format how exactly it holds the lens, or why it doesn't."""
    return [
        ExportRow(
            option.title,
            option.model or "-",
            "-" if option.error is None else tiny_pixels(option.error.rms),
            "-" if option.error is None else tiny_pixels(option.error.maximum),
            option.allowed,
            option.reason or "",
        )
        for option in options
    ]
