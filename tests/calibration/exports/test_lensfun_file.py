"""Lensfun's file: its elements, its units, and what Lensfun itself makes of it."""

from __future__ import annotations

import importlib
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.calibration.exports import choose_intrinsics, export_lens
from app.calibration.lens import CameraLens

lensfunpy: Any = importlib.import_module("lensfunpy")
etree: Any = importlib.import_module("lxml.etree")

BEYOND_THE_SCHEMA = {("lens", "center")}
"""Read by Lensfun, unknown to its own schema and used by none of its lenses."""


def exported(lens: CameraLens, name: str = "front") -> Any:
    return export_lens(lens, "lensfun", camera_name=name, intrinsics=choose_intrinsics(lens, focal_length=200), limit=9)


def vocabulary(tree: Any) -> tuple[set[tuple[str, str]], set[tuple[str, str]]]:
    """Pairs of parent and element, and of element and attribute."""
    elements = [each for each in tree.iter() if isinstance(each.tag, str)]
    nested = {(each.getparent().tag, each.tag) for each in elements if each.getparent() is not None}
    return nested, {(each.tag, name) for each in elements for name in each.attrib}


@pytest.fixture(scope="module")
def shipped() -> list[Any]:
    """Lensfun's own database."""
    return [etree.parse(str(path)) for path in sorted(Path(lensfunpy.__file__).parent.glob("db_files/*.xml"))]


@pytest.fixture(scope="module")
def known(shipped: list[Any]) -> tuple[set[tuple[str, str]], set[tuple[str, str]]]:
    pairs = [vocabulary(tree.getroot()) for tree in shipped]
    return {pair for nested, _ in pairs for pair in nested}, {pair for _, named in pairs for pair in named}


@pytest.fixture(scope="module")
def schema() -> Any:
    return etree.RelaxNG(etree.parse(str(Path(__file__).with_name("lensfun.rng"))))


def test_the_schema_is_that_of_lensfuns_database(shipped: list[Any], schema: Any) -> None:
    """All of its files but those with an element that has gone out of use."""
    fitting = [schema.validate(tree) for tree in shipped]
    outdated = [tree.find(".//real-focal-length") is not None for tree in shipped]
    assert sum(fitting) >= 40
    assert sum(fitting) + sum(outdated) >= len(shipped) - 1


@pytest.mark.parametrize("name", ["plain", "wide", "pincushion"])
def test_a_file_fits_lensfuns_schema(name: str, lenses: Mapping[str, CameraLens], schema: Any) -> None:
    tree = etree.fromstring(exported(lenses[name], 'Front "left" <é> & --x').content)
    schema.assertValid(tree)
    tree.find("lens").append(tree.find("lens/mount"))
    assert not schema.validate(tree)


@pytest.mark.parametrize("name", ["plain", "wide"])
def test_a_file_has_the_elements_of_lensfuns_own_database(
    name: str, lenses: Mapping[str, CameraLens], known: tuple[set[tuple[str, str]], set[tuple[str, str]]]
) -> None:
    nested, attributes = vocabulary(etree.fromstring(exported(lenses[name]).content))
    assert nested - known[0] <= BEYOND_THE_SCHEMA
    assert {pair for pair in attributes if ("lens", pair[0]) not in BEYOND_THE_SCHEMA} <= known[1]


def test_a_centre_in_the_middle_is_not_written(lenses: Mapping[str, CameraLens]) -> None:
    assert etree.fromstring(exported(lenses["plain"]).content).find("lens/center") is None
    assert etree.fromstring(exported(lenses["wide"]).content).find("lens/center") is not None


def test_the_unit_is_half_the_shorter_side() -> None:
    lens = CameraLens("opencv", 121, 81, (-0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0))
    distortion = etree.fromstring(exported(lens).content).find("lens/calibration/distortion")
    assert distortion.get("model") == "poly5"
    assert float(distortion.get("k1")) == pytest.approx(-0.1 * (40 / lens.scale) ** 2, rel=1e-6)
    assert float(distortion.get("k2")) == pytest.approx(0, abs=1e-9)


def test_a_lens_that_scales_keeps_the_circle_of_the_unit_in_place(lenses: Mapping[str, CameraLens]) -> None:
    lens = lenses["wide"]
    tree = etree.fromstring(exported(lens).content)
    distortion = tree.find("lens/calibration/distortion")
    assert distortion.get("model") == "ptlens"
    larger = float(re.findall(r"image is ([\d.]+) times", etree.tostring(tree).decode())[0])
    unit = (min(lens.width, lens.height) - 1) / 2
    # a point of ours at the circle over the scale is where Lensfun's circle is, seen without being moved
    ours = np.add(lens.center, [unit / larger, 0])
    seen = lens.distort(ours.reshape(1, 2))[0] - lens.center
    assert float(np.hypot(*seen)) == pytest.approx(unit, abs=0.1)


def test_lensfun_at_once_is_off_by_no_more_than_the_file_says(
    lenses: Mapping[str, CameraLens], lensfun_whole: Callable[..., Any]
) -> None:
    """Of the release of Lensfun that is installed: should this fail because it agrees, the note can go."""
    lens = lenses["wide"]
    file = exported(lens)
    corrected, seen = lensfun_whole(file, lens)
    expected = lens.distort(corrected)
    inside = ((expected >= 0) & (expected <= [lens.width - 1, lens.height - 1])).all(axis=1)
    off = np.hypot(*(seen - expected)[inside].T).max()
    stated = float(re.findall(r"can be ([\d.]+) px further", " ".join(file.notes))[0])
    assert 1.2 * file.error.maximum + 0.05 < off <= stated + 1.2 * file.error.maximum + 0.05


def test_the_focal_length_is_that_of_film(lenses: Mapping[str, CameraLens]) -> None:
    lens = lenses["plain"]
    tree = etree.fromstring(exported(lens).content)
    expected = 200 * np.hypot(36, 24) / np.hypot(lens.width, lens.height)
    assert float(tree.find("lens/focal").get("value")) == pytest.approx(expected, abs=1e-3)
    assert tree.findtext("camera/cropfactor") == tree.findtext("lens/cropfactor") == "1"
