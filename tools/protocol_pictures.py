"""Draw the pictures of docs/protocols.md: what counts and what doesn't, by the scorers themselves.

python tools/protocol_pictures.py

Every verdict in a picture is computed when it is drawn, so that a picture can't say anything else than the program.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from xml.etree.ElementTree import Element, ElementTree, SubElement, indent

import numpy as np
from numpy.typing import NDArray

from app.evaluation import Outcome, clearlines_v2, ground_truth, official_v1
from app.evaluation.covering import TAU
from app.evaluation.tallies import LAYOUT
from app.vision.segments import Segments

PICTURES = Path(__file__).resolve().parent.parent / "docs" / "pictures"
LENGTH = 120
"""Length of the label in every panel, px."""

COLUMNS = 3
PANEL = (290, 172)
SCALE = 1.8
MIDDLE = np.array([PANEL[0] / 2, 76.0])
HIT, FALSE_ALARM, MISS, IGNORED = "#0a7d33", "#c8281e", "#d97800", "#777777"
STROKES = {Outcome.HIT: (HIT, ""), Outcome.FALSE_ALARM: (FALSE_ALARM, "7 5"), Outcome.IGNORED: (IGNORED, "")}

Line = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Panel:
    """One label, what a detector found, and in words what is wrong with it."""

    title: str
    predictions: tuple[Line, ...]
    ambiguous: bool = False


def line(length: float = LENGTH, turn: float = 0.0, shift: float = 0.0, along: float = 0.0) -> Line:
    """A line beside the label: turned about its middle (degrees), shifted sideways and along (px)."""
    t = np.linspace(-length / 2, length / 2, round(length) + 1)
    angle = np.radians(turn)
    own = t[:, None] * np.array([np.cos(angle), np.sin(angle)]) + np.array([along, shift])
    return own @ _rotation(-20.0)


def arc() -> Line:
    """A curve from end to end of the label that stays in the label's bounding box."""
    begin, end = line()[[0, -1]]
    corner = np.array([begin[0], end[1]])
    t = np.linspace(0, 1, LENGTH + 1)[:, None]
    return (1 - t) ** 2 * begin + 2 * t * (1 - t) * corner + t**2 * end


def panels() -> list[Panel]:
    """What docs/protocols.md shows, in reading order."""
    cross = line() * [1, -1]
    return [
        Panel("the line itself", (line(),)),
        Panel("2.5 px beside it", (line(shift=2.5),)),
        Panel("4 px beside it", (line(shift=4),)),
        Panel("turned by 3 degrees", (line(turn=3),)),
        Panel("turned by 8 degrees", (line(turn=8),)),
        Panel("a line that crosses it", (cross,)),
        Panel("two thirds of it", (line(80, along=-20),)),
        Panel("two fifths of it", (line(48, along=-36),)),
        Panel("a curve between its ends", (arc(),)),
        Panel("two halves", (line(60, along=-30), line(60, along=30))),
        Panel("the line three times", (line(), line(shift=1.2), line(shift=-1.2))),
        Panel("an ambiguous line", (line(shift=1),), ambiguous=True),
    ]


def draw_panels(path: Path) -> None:
    """Draw all panels with the verdicts of clearlines-v2 and official-v1 below each."""
    shown = panels()
    rows = -(-len(shown) // COLUMNS)
    svg = _picture(COLUMNS * PANEL[0], rows * PANEL[1] + 34)
    for index, panel in enumerate(shown):
        row, column = divmod(index, COLUMNS)
        group = SubElement(svg, "g", transform=f"translate({column * PANEL[0]} {row * PANEL[1]})")
        _draw_panel(group, panel)
    _draw_legend(svg, rows * PANEL[1] + 18)
    _write(svg, path)


def draw_shifts(path: Path, length: int = 400) -> None:
    """Draw how far a line may be shifted sideways under either protocol, over its direction."""
    angles = np.arange(0, 91, 5)
    width, height, left, top, bottom, highest = 640, 320, 56, 40, 268, 80.0
    svg = _picture(width, height)
    _text(svg, (left, 24), f"Sideways shift at which a line of {length} px still counts", weight="bold")

    def place(angle: float, shift: float) -> str:
        return f"{left + angle / 90 * (width - left - 30):.1f},{bottom - shift / highest * (bottom - top):.1f}"

    for shift in (0, 20, 40, 60, 80):
        x, y = place(0, shift).split(",")
        SubElement(svg, "line", {"x1": x, "x2": str(width - 30), "y1": y, "y2": y, "stroke": "#ddd"})
        _text(svg, (left - 8, float(y) + 4), f"{shift} px" if shift else "0", anchor="end")
    for angle in range(0, 91, 15):
        _text(svg, (float(place(angle, 0).split(",")[0]), bottom + 20), f"{angle}°", anchor="middle")
    _text(svg, ((left + width) / 2, height - 12), "direction of the line", anchor="middle")

    for protocol, color, dashes in (("official-v1", FALSE_ALARM, "7 5"), ("clearlines-v2", HIT, "")):
        shifts = [accepted_shift(protocol, float(angle), length) for angle in angles]
        points = " ".join(place(float(angle), shift) for angle, shift in zip(angles, shifts, strict=True))
        _polyline(svg, points, color, dashes, 2.5)
        x, y = (float(value) for value in place(64, float(np.interp(64, angles, shifts))).split(","))
        ends = dict.fromkeys(f"{shift:.1f}" for shift in (min(shifts), max(shifts)))
        _text(svg, (x + 8, y - 10), f"{protocol}: {' to '.join(ends)} px", color=color, weight="bold")
    _write(svg, path)


def accepted_shift(protocol: str, angle: float, length: int) -> float:
    """Return the greatest sideways shift of a line that still counts, px, up to a quarter of it."""
    t = np.linspace(-length / 2, length / 2, length + 1)
    label = t[:, None] * np.array([1.0, 0.0]) @ _rotation(angle)
    normal = np.array([0.0, 1.0]) @ _rotation(angle)
    score = official_v1.score_image if protocol == official_v1.PROTOCOL else clearlines_v2.score_image
    truth = ground_truth(Segments.from_list([label]))
    low, high = 0.0, length / 4
    while high - low > 0.02:
        middle = (low + high) / 2
        hit = score(truth, Segments.from_list([label + middle * normal])).outcomes.predictions[0] == Outcome.HIT
        low, high = (middle, high) if hit else (low, middle)
    return low


def verdicts(panel: Panel) -> tuple[clearlines_v2.ImageScore, official_v1.ImageScore]:
    """Score a panel under both protocols."""
    label = Segments.from_list([line()])
    truth = ground_truth(Segments.from_list([]), label) if panel.ambiguous else ground_truth(label)
    predictions = Segments.from_list(panel.predictions)
    return clearlines_v2.score_image(truth, predictions), official_v1.score_image(truth, predictions)


def _draw_panel(group: Element, panel: Panel) -> None:
    ours, official = verdicts(panel)
    frame = {"x": "4", "y": "4", "width": str(PANEL[0] - 8), "height": str(PANEL[1] - 8), "rx": "6"}
    SubElement(group, "rect", {**frame, "fill": "#fafafa", "stroke": "#ddd"})
    _text(group, (14, 24), panel.title, weight="bold")

    band = _polyline(group, _points(line()), "#cfe3f7", "", 2 * TAU * SCALE)
    band.set("stroke-linecap", "round")
    label = Outcome(int(ours.outcomes.labels[0]))
    color, dashes, width = {
        Outcome.MISS: (MISS, "1 7", 4.0),
        Outcome.HIT: ("#5b8db8", "", 1.5),
        Outcome.IGNORED: (IGNORED, "2 4", 1.5),
    }[label]
    _polyline(group, _points(line()), color, dashes, width).set("stroke-linecap", "round")
    for points, outcome in zip(panel.predictions, ours.outcomes.predictions.tolist(), strict=True):
        _polyline(group, _points(points), *STROKES[Outcome(outcome)], 2.0)

    part = LAYOUT.unpack(ours.tallies)
    counts = " ".join(f"{name.upper()} {int(part[name])}" for name in ("tp", "fp", "fn"))
    best = f"line IoU {ours.best_liou.max():.2f}" if len(ours.best_liou) else ""
    _text(group, (14, PANEL[1] - 32), f"clearlines-v2: {counts}, {best}")
    recall = "-" if official.recall is None else f"{official.recall:g}"
    _text(group, (14, PANEL[1] - 15), f"official-v1: P {official.precision:g}, R {recall}", color="#666")


def _draw_legend(svg: Element, y: float) -> None:
    x = 14.0
    entries = (
        (HIT, "", 2.0, "hit (TP)"),
        (FALSE_ALARM, "7 5", 2.0, "false alarm (FP)"),
        (MISS, "1 7", 4.0, "label that is missed (FN)"),
        (IGNORED, "", 2.0, "not counted"),
        ("#cfe3f7", "", 2 * TAU * SCALE, "within 3 px of the label"),
    )
    for color, dashes, width, words in entries:
        _polyline(svg, f"{x},{y} {x + 34},{y}", color, dashes, width).set("stroke-linecap", "round")
        _text(svg, (x + 46, y + 4), words)
        x += 70 + 6.6 * len(words)


def _points(points: Line) -> str:
    return " ".join(f"{x:.1f},{y:.1f}" for x, y in points[::6] * SCALE + MIDDLE)


def _rotation(degrees: float) -> NDArray[np.float64]:
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    return np.array([[c, s], [-s, c]])


def _picture(width: float, height: float) -> Element:
    size = {"viewBox": f"0 0 {width:g} {height:g}", "width": f"{width:g}"}
    svg = Element("svg", {"xmlns": "http://www.w3.org/2000/svg", **size, "font-family": "sans-serif"})
    svg.set("font-size", "12")
    SubElement(svg, "rect", width="100%", height="100%", fill="#fff")
    return svg


def _polyline(parent: Element, points: str, color: str, dashes: str, width: float) -> Element:
    stroke = {"points": points, "fill": "none", "stroke": color, "stroke-width": f"{width:g}"}
    return SubElement(parent, "polyline", stroke | ({"stroke-dasharray": dashes} if dashes else {}))


def _text(
    parent: Element,
    at: Sequence[float],
    words: str,
    *,
    anchor: str = "start",
    weight: str = "normal",
    color: str = "#222",
) -> None:
    place = {"x": f"{at[0]:g}", "y": f"{at[1]:g}", "text-anchor": anchor, "font-weight": weight, "fill": color}
    SubElement(parent, "text", place).text = words


def _write(svg: Element, path: Path) -> None:
    indent(svg)
    ElementTree(svg).write(path, encoding="utf-8")
    print(f"drawn: {path}")


if __name__ == "__main__":
    draw_panels(PICTURES / "protocols-what-counts.svg")
    draw_shifts(PICTURES / "protocols-accepted-shift.svg")
