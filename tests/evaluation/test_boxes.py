from __future__ import annotations

import numpy as np
import pytest

from app.evaluation import boxes
from app.evaluation.boxes import box_iou, padded_boxes
from app.vision.segments import Segments


def padded(*points: tuple[float, float]) -> list[float]:
    return padded_boxes(Segments.from_list([np.array(points)]))[0].tolist()


def test_a_large_box_is_the_extremes_of_the_points_in_any_order() -> None:
    assert padded((30, 5), (10, 40), (20, 20)) == [10, 5, 30, 40]


def test_short_sides_are_padded_to_10_px_on_both_ends_alike() -> None:
    assert padded((0, 0), (100, 0)) == [0, -5, 100, 5]
    assert padded((0, 0), (4, 100)) == [-3, 0, 7, 100]
    assert padded((7, 9)) == [2, 4, 12, 14]


def test_a_side_of_exactly_10_px_stays() -> None:
    assert padded((0, 0), (10, 10)) == [0, 0, 10, 10]


def test_iou_of_known_boxes() -> None:
    a = np.array([[0.0, 0, 10, 10], [20, 20, 40, 40]])
    b = np.array([[0.0, 0, 10, 10], [5, 0, 15, 10], [10, 0, 20, 10], [30, 30, 50, 50]])
    expected = [[1, 50 / 150, 0, 0], [0, 0, 0, 100 / 700]]
    assert box_iou(a, b) == pytest.approx(np.array(expected))


def test_boxes_without_area_have_no_overlap() -> None:
    nothing = np.array([[3.0, 3, 3, 3]])
    assert box_iou(nothing, nothing).tolist() == [[0.0]]


@pytest.mark.parametrize(("a", "b"), [(0, 3), (3, 0), (0, 0)])
def test_no_boxes_give_an_empty_matrix(a: int, b: int) -> None:
    assert box_iou(np.zeros((a, 4)), np.zeros((b, 4))).shape == (a, b)


def test_blocks_of_rows_give_the_same_matrix(monkeypatch: pytest.MonkeyPatch) -> None:
    corners = np.random.default_rng(1).uniform(0, 50, (40, 2, 2))
    some = np.concatenate([corners.min(axis=1), corners.max(axis=1)], axis=1)
    whole = box_iou(some, some[:17])
    monkeypatch.setattr(boxes, "_BLOCK_CELLS", 50)
    assert (box_iou(some, some[:17]) == whole).all()
    assert [rows.stop - rows.start for rows, _ in boxes.iou_blocks(some, some[:17])] == [2] * 20
