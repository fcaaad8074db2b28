from __future__ import annotations

import pytest

from app.errors import InvalidInput
from app.evaluation import clearlines_v2, ground_truth, official_v1
from app.evaluation.ground_truth import GroundTruth
from app.evaluation.table_one import TableRow, table_one, table_rows, table_text
from app.vision.segments import Segments


@pytest.fixture
def images(line) -> list[tuple[str | None, GroundTruth, Segments]]:
    """KITTI: two of four candidates kept and one line added; IAMCV: all kept; one image of no source, none kept."""
    lines = [line(300, 0, (500.0, 100.0 * row)) for row in range(1, 7)]
    labels, added = lines[:2], lines[5]
    return [
        ("KITTI", ground_truth(Segments.from_list([*labels, added])), Segments.from_list(lines[:4])),
        (None, ground_truth(Segments.empty()), Segments.from_list(lines[:1])),
        ("IAMCV", ground_truth(Segments.from_list(labels)), Segments.from_list(labels)),
        ("KITTI", ground_truth(Segments.from_list(labels)), Segments.from_list(labels)),
    ]


def test_a_row_per_source_and_one_for_all(images) -> None:
    rows = table_one(images)
    assert [(row.source, row.images) for row in rows] == [("IAMCV", 1), ("KITTI", 2), (None, 1), ("all", 4)]
    assert rows[0] == TableRow("IAMCV", 1, 1, 1, 1, 1)
    kitti = rows[1]
    assert (kitti.precision, kitti.recall) == pytest.approx(((0.5 + 1) / 2, (2 / 3 + 1) / 2))
    assert kitti.f1_v2 == pytest.approx(2 * 4 / (2 * 4 + 2 + 1))
    assert rows[2] == TableRow(None, 1, 0, 0, 0, 0)


def test_official_numbers_are_those_of_the_protocol_over_all_images(images) -> None:
    total = official_v1.total([official_v1.score_image(truth, candidates) for _, truth, candidates in images])
    row = table_one(images)[-1]
    assert (row.precision, row.recall, row.f1) == pytest.approx((total.precision, total.recall, total.f1), abs=1e-12)


def test_a_single_source_has_a_single_row_and_none_has_none(images) -> None:
    assert len(table_one(images[:1])) == 1
    assert table_one([]) == []


def test_text_is_in_the_papers_form(images) -> None:
    assert table_text(table_one(images)).splitlines() == [
        "source       images     P     R    F1  F1 clearlines-v2",
        "IAMCV             1  1.00  1.00  1.00              1.00",
        "KITTI             2  0.75  0.83  0.79              0.73",
        "(no source)       1  0.00  0.00  0.00              0.00",
        "all               4  0.62  0.89  0.73              0.75",
    ]
    assert table_text([]).count("\n") == 1


def test_tallies_of_other_images_are_refused(images) -> None:
    _, truth, candidates = images[0]
    tallies = {
        protocol.PROTOCOL: protocol.score_image(truth, candidates).tallies[None]
        for protocol in (official_v1, clearlines_v2)
    }
    with pytest.raises(InvalidInput, match="2 images"):
        table_rows(["a", "b"], tallies)
