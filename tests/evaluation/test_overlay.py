from __future__ import annotations

import numpy as np
import pytest

from app.errors import InvalidImage
from app.evaluation import draw_overlay, ground_truth
from app.evaluation.legend import Entry, legend_band
from app.evaluation.official_v1 import ImageScore, score_image
from app.evaluation.overlay import STROKES, line_width
from app.vision.segments import Segments

WIDTH, HEIGHT = 400, 300


def horizontal(y: float) -> np.ndarray:
    return np.stack([np.arange(50.0, 351), np.full(301, y)], axis=1)


def scene() -> tuple[Segments, Segments, ImageScore]:
    """A hit at y = 50, a false alarm at 120, a miss at 190, an ignored pair at 260."""
    truth = ground_truth(Segments.from_list([horizontal(50), horizontal(190)]), Segments.from_list([horizontal(260)]))
    predictions = Segments.from_list([horizontal(50), horizontal(120), horizontal(260)])
    return truth.segments, predictions, score_image(truth, predictions)


def is_colored(rows: np.ndarray) -> np.ndarray:
    return (rows.max(axis=-1).astype(int) - rows.min(axis=-1)) > 100


@pytest.mark.parametrize("gray", [0, 128, 255])
def test_the_colours_are_green_red_and_orange_on_dark_and_bright_images(gray: int) -> None:
    picture = draw_overlay(np.full((HEIGHT, WIDTH), gray, np.uint8), *scene())
    hit, false_alarm, miss = picture[50, 50:350], picture[120, 50:350], picture[190, 50:350]
    for row, blue_green_red in ((hit, (0, 1, 0)), (false_alarm, (0, 0, 1)), (miss, (0, 0.6, 1))):
        color = row[is_colored(row)].mean(axis=0)
        assert np.corrcoef(color, blue_green_red)[0, 1] > 0.9


@pytest.mark.parametrize("gray", [60, 128, 255])
def test_each_line_has_a_dark_casing(gray: int) -> None:
    picture = draw_overlay(np.full((HEIGHT, WIDTH), gray, np.uint8), *scene())
    background = int(picture[5, 5, 0])
    for y in (50, 120, 190):
        lines = picture[y - 5 : y + 6, 60:340]
        assert lines.max(axis=-1).min() < 0.75 * background


def test_the_three_differ_without_colour() -> None:
    picture = draw_overlay(np.full((HEIGHT, WIDTH), 128, np.uint8), *scene())

    def pieces(y: int) -> int:
        return int((np.diff(is_colored(picture[y, 40:360]).astype(int)) == 1).sum())

    assert pieces(50) == 1
    assert 10 < pieces(120) < 30
    assert pieces(190) > 40


def test_a_found_label_is_not_drawn_and_an_ignored_one_is_grey() -> None:
    labels, predictions, score = scene()
    moved = Segments(labels.points + np.array([0, 3], np.float32), labels.offsets)
    picture = draw_overlay(np.zeros((HEIGHT, WIDTH), np.uint8), moved, predictions, score)
    assert not is_colored(picture[54]).any()
    gray = picture[263, 60:340]
    assert not is_colored(gray).any()
    assert gray.max() > 150


def test_the_picture_lies_at_full_resolution_above_the_legend() -> None:
    random = np.random.default_rng(0).integers(0, 256, (HEIGHT, WIDTH, 3), dtype=np.uint8)
    nothing = Segments.empty()
    picture = draw_overlay(random, nothing, nothing, score_image(ground_truth(nothing), nothing))
    assert picture.dtype == np.uint8
    assert picture.shape[0] > HEIGHT
    assert picture.shape[1:] == (WIDTH, 3)
    luma = random @ np.array([0.114, 0.587, 0.299])
    assert np.corrcoef(luma.ravel(), picture[:HEIGHT, :, 0].ravel())[0, 1] > 0.999
    assert picture[HEIGHT:].mean() > 200


@pytest.mark.parametrize("size", [(1, 1), (30, 20), (20, 300)])
def test_small_images_get_a_legend_that_fits(size: tuple[int, int]) -> None:
    labels, predictions, score = scene()
    picture = draw_overlay(np.zeros(size, np.uint8), labels, predictions, score)
    assert picture.shape[1] >= size[1]
    legend = picture[size[0] :]
    assert (legend[:, -3:] > 200).all(), "text runs over the edge"


def test_legend_entries_that_do_not_fit_go_below() -> None:
    entries = [Entry(stroke, "a long explanation") for stroke in STROKES.values()]
    assert legend_band(entries, "caption", 300, 2.0).shape[0] > 2 * legend_band(entries, "caption", 2000, 2.0).shape[0]


def test_lines_grow_with_the_picture() -> None:
    assert line_width(640, 480) == line_width(100, 100) == 2.2
    assert line_width(8000, 6000) == 15.625


@pytest.mark.parametrize(
    "image",
    [np.zeros((5, 5), np.uint16), np.zeros((5, 5, 4), np.uint8), np.zeros((0, 5), np.uint8), np.zeros(5, np.uint8)],
)
def test_other_images_are_refused(image: np.ndarray) -> None:
    with pytest.raises(InvalidImage, match="drawn on"):
        draw_overlay(image, *scene())
