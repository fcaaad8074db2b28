from __future__ import annotations

import json

import pytest

from app.evaluation import ground_truth
from app.evaluation.official_v1 import ImageScore, score_image
from app.evaluation.summary import Evaluation, image_content, summary_content, summary_text
from app.vision.segments import Segments


def score(labels, predictions, ambiguous=()) -> ImageScore:
    truth = ground_truth(Segments.from_list(labels), Segments.from_list(ambiguous))
    return score_image(truth, Segments.from_list(predictions))


@pytest.fixture
def evaluation(line) -> Evaluation:
    one, far = line(200), line(200, 0, (900.0, 900.0))
    return Evaluation(
        names=("a", "b/c", "d"),
        scores=(score([one], [one, one, one, far]), score([one, far], []), score([], [one])),
        missing=("b/c",),
        extra=("x", "y"),
        min_length=50,
    )


def test_the_first_four_lines_are_those_of_the_papers_script(evaluation: Evaluation) -> None:
    assert summary_text(evaluation).splitlines()[:4] == [
        "Results for Intersection over Union (IoU) of: 0.5",
        "Average Precision: 0.25",
        "Average Recall: 1.50",
        "F1 Score;: 0.43",
    ]


def test_the_rest_says_what_the_numbers_stand_on(evaluation: Evaluation) -> None:
    text = summary_text(evaluation)
    assert "Protocol: official-v1" in text
    assert "Shortest line that counts: 50 px" in text
    assert "Lowest recall: 0.00 (b/c), highest: 3.00 (a)" in text
    assert "scored as empty (1):\n- b/c\n" in text
    assert "not scored (2):\n- x\n- y\n" in text


def test_the_consequences_that_apply_are_said_and_no_others(evaluation: Evaluation, line) -> None:
    said = " ".join(summary_content(evaluation)["consequences"])
    assert "2 of 3 true positives" in said
    assert "Recall exceeds 1 in 1 image (a)" in said
    assert "Predictions but no labels in 1 image (d)" in said
    assert "No predictions in 1 image (b/c)" in said
    assert "No labels and no predictions" not in said
    assert "F1 is set to 0" not in said
    fine = Evaluation(("a",), (score([line(200)], [line(200)]),))
    assert len(summary_content(fine)["consequences"]) == 1
    nothing = Evaluation(tuple("abcdefg"), (score([], []),) * 7)
    said = " ".join(summary_content(nothing)["consequences"])
    assert "No labels and no predictions in 7 images (a, b, c, d, e and 2 more)" in said
    assert "F1 is set to 0" in said


def test_the_json_holds_unrounded_numbers_counts_and_names(evaluation: Evaluation) -> None:
    content = json.loads(json.dumps(summary_content(evaluation), allow_nan=False))
    assert content["protocol"] == "official-v1"
    assert (content["precision"], content["recall"]) == (0.25, 1.5)
    assert content["f1"] == pytest.approx(2 * 0.25 * 1.5 / 1.75, abs=1e-15)
    assert content["images"] == 3
    assert content["counts"] == {
        "labels": 3,
        "predictions": 5,
        "true_positives": 3,
        "ignored_labels": 0,
        "ignored_predictions": 0,
        "images_without_recall": 1,
    }
    assert (content["missing"], content["extra"]) == (["b/c"], ["x", "y"])


def test_an_image_says_what_became_of_each_segment(line) -> None:
    one, unsure, far = line(200), line(100, 90, (100.0, 100.0)), line(200, 0, (900.0, 900.0))
    content = image_content("a", score([one], [far, one, unsure], [unsure]), [0, 2, 5])
    assert content["prediction_outcomes"] == [
        {"index": 0, "outcome": "false_alarm", "best_iou": 0.0, "best_label": None},
        {"index": 2, "outcome": "hit", "best_iou": 1.0, "best_label": 0},
        {"index": 5, "outcome": "ignored", "best_iou": 0.0, "best_label": None},
    ]
    assert content["label_outcomes"] == ["hit", "ignored"]
    assert (content["predictions"], content["labels"]) == (2, 1)
