"""The report is one page that needs nothing else, runs nothing, and says what the calibration says."""

from __future__ import annotations

import re
from dataclasses import replace
from datetime import UTC, datetime
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
from hatchling.builders.wheel import WheelBuilder

from app.calibration.calibrate import CalibrationImage, calibrate
from app.calibration.calibration import Calibration, Warned
from app.calibration.comparison import compare
from app.calibration.exports.intrinsics import Intrinsics
from app.calibration.focal_length import FocalEstimate
from app.calibration.lens import CameraLens
from app.calibration.report.report import TEMPLATES, ReportPicture, report_html
from app.calibration.report.words import ADVICE, pixels, with_sigma
from app.vision.segments import Segments

ROOT = Path(__file__).parents[2]
CREATED = datetime(2026, 3, 4, 15, 40, tzinfo=UTC)
TRUE = CameraLens("opencv", 1242, 375, (-0.18, 0.05, 0.0, 0.0, 0.0, 0.01, -0.02))
VOID = {"meta", "img", "br", "link", "hr", "input"}


def straight_lines(seed: int, count: int) -> Segments:
    """Lines that are straight under the lens, as it shows them, with the noise of a good detector."""
    rng = np.random.default_rng(seed)
    lines = []
    while len(lines) < count:
        angle, middle = rng.uniform(0, np.pi), rng.uniform([0, 0], [TRUE.width, TRUE.height])
        along = np.arange(-150.0, 151.0)[:, None] * [np.cos(angle), np.sin(angle)]
        points = TRUE.distort(TRUE.undistort(middle[None]) + along)
        inside = (points >= 0).all(axis=1) & (points <= [TRUE.width - 1, TRUE.height - 1]).all(axis=1)
        if inside.sum() > 100:
            lines.append(points[inside] + rng.normal(0, 0.15, (int(inside.sum()), 2)))
    return Segments.from_list(lines)


@pytest.fixture(scope="module")
def calibration() -> Calibration:
    images = [CalibrationImage(f"drive/{seed:06d}", straight_lines(seed, 12)) for seed in range(4)]
    return calibrate(images, (TRUE.width, TRUE.height), family="opencv")


class Page(HTMLParser):
    """What a page consists of."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.open: list[str] = []
        self.words: list[str] = []
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] not in ("style", "title"):
            self.words.append(data)

    @property
    def text(self) -> str:
        return " ".join(" ".join(self.words).split())


def test_it_says_what_the_calibration_says(calibration: Calibration) -> None:
    page = Page(report_html(calibration, camera_name="front", created=CREATED))
    assert page.open == []
    known = calibration.uncertainty
    for part in ("front", "1242 × 375 px", "4 March 2026, 15:40 UTC", "Can be used", "48 lines"):
        assert part in page.text
    for value in (known.pred, known.bound95, known.correction, known.jackknife):
        assert pixels(value) in page.text
    for name, sigma in calibration.sigma.items():
        value = calibration.lens.parameters[calibration.lens.names.index(name)]
        assert " ".join(with_sigma(value, sigma)) in page.text
    assert page.text.count("drive/0000") >= 10  # lines that fit worst, and each image
    assert all(rung.reason in page.text for rung in calibration.ladder)
    assert "Lines by residual" in page.text
    assert "OpenCV's D" in page.text
    assert "nominal, NOT measured" in page.text


def test_it_is_self_contained_and_runs_nothing(calibration: Calibration) -> None:
    name = "<img src=x onerror=alert(1)>\"'&<script>alert(2)</script>"
    hostile = replace(
        calibration,
        images=tuple(image._replace(name=name) for image in calibration.images),
        warnings=(Warned("one-band", name),),
        reasons=(name,),
        accepted=False,
    )
    picture = ReportPicture(name, b"\xff\xd8\xff")
    difference = compare(calibration.lens, TRUE, 1242, 375)
    page = Page(
        report_html(
            hostile,
            camera_name=name,
            created=CREATED,
            pictures=[picture],
            difference=difference,
            reference_name=name,
            options=[],
        )
    )
    assert page.open == []
    assert {"script", "link", "iframe", "object", "foreignobject", "base", "form"}.isdisjoint(
        tag for tag, _ in page.tags
    )
    for _, attributes in page.tags:
        assert not [key for key in attributes if key.startswith("on") or key in ("href", "xlink:href", "srcset")]
        assert (attributes.get("src") or "data:image/jpeg;base64,").startswith("data:image/jpeg;base64,")
    assert page.text.count(name) >= 6
    style = (TEMPLATES / "report.css").read_text()
    assert not re.search(r"url\(|@import|expression", style)


def test_a_refused_calibration_says_why_and_what_to_do(calibration: Calibration) -> None:
    refused = replace(
        calibration,
        accepted=False,
        reasons=("not enough information: 2 usable lines",),
        warnings=(Warned("few-lines", "only 2 straight lines"), Warned("of-tomorrow", "an unknown thing")),
    )
    text = Page(report_html(refused, camera_name="front", created=CREATED)).text
    assert "Not to be used" in text
    assert "2 usable lines" in text
    assert f"Only 2 straight lines. {ADVICE['few-lines']}" in text
    assert "An unknown thing." in text
    assert "isn't good enough to be used" in text


def test_a_camera_without_any_line_has_a_report() -> None:
    nothing = calibrate([CalibrationImage("a", Segments.empty())], (640, 480))
    text = Page(report_html(nothing, camera_name="front", created=CREATED)).text
    assert "Not to be used" in text
    assert not re.search(r"\b(nan|inf|None)\b", text)


def test_what_is_known_besides_stands_in_it(calibration: Calibration) -> None:
    focal = FocalEstimate(True, 721.5, 3.25, (600.0, 180.0), (4.0, 5.0), None, 3)
    free = {
        "used": True, "lines": 48, "needed": 30, "reason": None, "columns": 2, "rows": 2, "x": [0, 1241], "y": [0, 374],
        "dx": [[0.1, 0], [0, 0.2]], "dy": [[0, 0], [0, 0.1]], "rms": 0.123, "sigma": 0.045,
    }  # fmt: skip
    whole = replace(calibration, focal=focal.as_dict(), free=free)
    difference = compare(calibration.lens, TRUE, 1242, 375)
    text = Page(
        report_html(
            whole, camera_name="c", created=CREATED, difference=difference, reference_name="chessboard.yaml", options=[]
        )
    ).text
    for part in (
        "721.5 px ± 3.2 px", "Principal point 600.0, 180.0 px", "estimated from vanishing points",
        "comes to 0.12 px RMS", "Difference to chessboard.yaml", f"{pixels(difference.rms)} RMS",
    ):  # fmt: skip
        assert part in text
    given = Intrinsics(700.0, (621.0, 187.0), "given")
    assert (
        "given by a person"
        in Page(report_html(whole, camera_name="c", created=CREATED, intrinsics=given, options=[])).text
    )
    without = replace(calibration, lines=())
    assert "Lines by residual" not in Page(report_html(without, camera_name="c", created=CREATED, options=[])).text


def test_the_templates_are_files_of_the_wheel() -> None:
    wheel = {file.distribution_path for file in WheelBuilder(str(ROOT)).recurse_included_files()}
    assert {path.relative_to(ROOT).as_posix() for path in TEMPLATES.iterdir()} <= wheel
    names = {path.name for path in TEMPLATES.iterdir()}
    assert {"report.html.j2", "report.css"} <= names
    includes = set(re.findall(r'include "([^"]+)"', (TEMPLATES / "report.html.j2").read_text()))
    assert includes == names - {"report.html.j2", "report.css"}


@pytest.mark.parametrize(
    ("value", "expected"),
    [(0.0123, "0.012 px"), (0.456, "0.46 px"), (12.34, "12.3 px"), (123.4, "123 px"), (None, "unknown"),
     (float("inf"), "unknown")],
)  # fmt: skip
def test_lengths_have_two_telling_digits(value: float | None, expected: str) -> None:
    assert pixels(value) == expected


def test_a_value_has_the_decimals_of_its_sigma() -> None:
    assert with_sigma(-0.17932, 0.00046) == ("−0.17932", "0.00046")
    assert with_sigma(0.5, 0.0) == ("+0.500000", "-")
