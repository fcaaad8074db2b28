from __future__ import annotations

import json

import pytest

from app.evaluation import clearlines_v2, ground_truth, official_v1, official_v1_fixed
from app.evaluation.metric_labels import METRIC_LABELS
from app.evaluation.protocols import protocol_named
from app.evaluation.submission_scoring import ScoredImage, SplitImageInfo, score_image, score_totals
from app.evaluation.summary import Evaluation, summary_text
from app.evaluation.summary_json import image_content, summary_content
from app.vision.segments import Segments

PROTOCOLS = (official_v1.PROTOCOL, official_v1_fixed.PROTOCOL, clearlines_v2.PROTOCOL)


def image(name: str, labels, predictions, ambiguous=(), size: int | None = 1000) -> ScoredImage:
    truth = ground_truth(Segments.from_list(labels), Segments.from_list(ambiguous))
    return ScoredImage(SplitImageInfo(name, size, size), truth, Segments.from_list(predictions))


def evaluated(images: list[ScoredImage], protocol: str = official_v1.PROTOCOL, **fields) -> Evaluation:
    scored = [score_image(each) for each in images]
    infos = [each.info for each in images]
    return Evaluation(
        protocol,
        tuple(info.name for info in infos),
        tuple(scores[protocol] for _, scores in scored),
        score_totals(infos, [record for record, _ in scored], draws=100),
        **fields,
    )


@pytest.fixture
def images(line) -> list[ScoredImage]:
    one, far = line(200), line(200, 0, (900.0, 900.0))
    return [image("a", [one], [one, one, one, far]), image("b/c", [one, far], []), image("d", [], [one])]


@pytest.fixture
def evaluation(images: list[ScoredImage]) -> Evaluation:
    return evaluated(images, missing=("b/c",), extra=("x", "y"), min_length=50)


def test_the_first_four_lines_are_those_of_the_papers_script(evaluation: Evaluation) -> None:
    assert summary_text(evaluation).splitlines()[:4] == [
        "Results for Intersection over Union (IoU) of: 0.5",
        "Average Precision: 0.25",
        "Average Recall: 1.50",
        "F1 Score;: 0.43",
    ]


@pytest.mark.parametrize(
    ("protocol", "first"),
    [
        (official_v1_fixed.PROTOCOL, "Results for Intersection over Union (IoU) of: 0.5"),
        (clearlines_v2.PROTOCOL, "Results for line IoU of: 0.5"),
    ],
)
def test_other_protocols_begin_in_the_same_form_with_their_own_numbers(images, protocol: str, first: str) -> None:
    text = summary_text(evaluated(images, protocol))
    assert text.splitlines()[:4] == [first, "Precision: 0.20", "Recall: 0.33", "F1 Score: 0.25"]
    assert f"Protocol: {protocol}" in text
    assert "What to know about these numbers" not in text


def test_the_rest_says_what_the_numbers_stand_on(evaluation: Evaluation) -> None:
    text = summary_text(evaluation)
    assert "Protocol: official-v1" in text
    assert "Shortest line that counts: 50 px" in text
    assert "Lowest recall: 0.00 (b/c), highest: 3.00 (a)" in text
    assert "scored as empty (1):\n- b/c\n" in text
    assert "not scored (2):\n- x\n- y\n" in text


def test_every_protocol_and_its_intervals_are_listed_whatever_comes_first(images: list[ScoredImage]) -> None:
    for protocol in PROTOCOLS:
        lines = summary_text(evaluated(images, protocol)).splitlines()
        assert any("95 % intervals (bootstrap, 100 draws of 3 images)" in line for line in lines)
        assert all(f"  {name}" in lines for name in PROTOCOLS)
        rank_key = next(line for line in lines if "rank key" in line)
        assert rank_key.split()[-3:] == ["0.250", "[0.000,", "0.400]"]
        assert "Errors under clearlines-v2: 2 duplicate, 2 background, 2 missed" in lines
        assert any(line.split()[:3] == ["orientation", "horizontal", "0.250"] for line in lines)
        assert any(line.startswith("    Recall exceeds 1") for line in lines)
        assert not any("people rejected" in line for line in lines)


def test_every_metric_but_counts_and_grid_has_a_label() -> None:
    named = {name for protocol in PROTOCOLS for name in protocol_named(protocol).metric_names}
    assert named - set(METRIC_LABELS) == {"tp", "fp", "fn", "f1_grid"}
    assert set(METRIC_LABELS) - named == {"ap", "calibration_rms", "calibration_grid"}


@pytest.mark.parametrize(
    ("sequences", "said", "intervals"),
    [
        (("s", "s", None), "draws of 3 images in 2 sequences", True),
        (("s", "s", "s"), "without intervals, which a single sequence can't give", False),
    ],
)
def test_images_of_one_sequence_are_drawn_together(images, sequences, said: str, intervals: bool) -> None:
    together = [
        ScoredImage(SplitImageInfo(each.info.name, sequence=sequence), each.truth, each.predictions)
        for each, sequence in zip(images, sequences, strict=True)
    ]
    text = summary_text(evaluated(together))
    assert said in text
    assert ("[" in text) == intervals


def test_without_sizes_no_stratum_is_told_by_distance(line) -> None:
    text = summary_text(evaluated([image("a", [line(200)], [], size=None)]))
    assert "length 200-400 px" in text
    assert "distance" not in text


def test_the_consequences_that_apply_are_said_and_no_others(evaluation: Evaluation, line) -> None:
    said = " ".join(summary_content(evaluation)["consequences"])
    assert "2 of 3 true positives" in said
    assert "Recall exceeds 1 in 1 image (a)" in said
    assert "Predictions but no labels in 1 image (d)" in said
    assert "No predictions in 1 image (b/c)" in said
    assert "No labels and no predictions" not in said
    assert "F1 is set to 0" not in said
    fine = evaluated([image("a", [line(200)], [line(200)])])
    assert len(summary_content(fine)["consequences"]) == 1
    nothing = evaluated([image(name, [], []) for name in "abcdefg"])
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
    assert content["totals"]["protocols"]["clearlines-v2"]["totals"]["f1"]["value"] == pytest.approx(0.25)


def test_an_image_says_what_became_of_each_segment(line) -> None:
    one, unsure, far = line(200), line(100, 90, (100.0, 100.0)), line(200, 0, (900.0, 900.0))
    short = line(20)
    record, scores = score_image(image("a", [one], [far, short, one, unsure], [unsure]), min_length=50)
    content = image_content("a", scores[official_v1.PROTOCOL], record)
    assert content["prediction_outcomes"] == [
        {"index": 0, "outcome": "false_alarm", "best_iou": 0.0, "best_label": None},
        {"index": 2, "outcome": "hit", "best_iou": 1.0, "best_label": 0},
        {"index": 3, "outcome": "ignored", "best_iou": 0.0, "best_label": None},
    ]
    assert content["label_outcomes"] == ["hit", "ignored"]
    assert (content["predictions"], content["labels"]) == (2, 1)
    assert (content["metrics"]["f1"], content["metrics"]["fixed_f1"]) == (pytest.approx(2 / 3), pytest.approx(2 / 3))


def test_under_clearlines_v2_it_also_says_how_exact_a_hit_is_and_how_wrong_the_rest(line) -> None:
    one, far = line(200), line(200, 0, (900.0, 900.0))
    record, scores = score_image(image("a", [one, far], [one[:80], one]))
    content = json.loads(json.dumps(image_content("a", scores[clearlines_v2.PROTOCOL], record), allow_nan=False))
    piece, whole = content["prediction_outcomes"]
    assert (piece["outcome"], piece["error_type"], piece["offset"]) == ("false_alarm", "fragment", None)
    assert (whole["outcome"], whole["error_type"], whole["best_label"]) == ("hit", None, 0)
    assert (whole["liou"], whole["offset"], whole["angle"]) == pytest.approx((1, 0, 0), abs=1e-6)
    assert content["label_error_types"] == [None, "missed"]
