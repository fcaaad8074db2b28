from __future__ import annotations

import io
import json
import pickle

import numpy as np
import pytest

from app.errors import InvalidFile, InvalidInput, TooLarge
from app.evaluation import clearlines_v2, ground_truth, official_v1, official_v1_fixed
from app.evaluation.error_types import ErrorType
from app.evaluation.ground_truth import long_enough
from app.evaluation.outcome import Outcome
from app.evaluation.submission_scoring import (
    ImageRecord,
    ScoredImage,
    SplitImageInfo,
    measure_of,
    score_cameras,
    score_part,
    score_totals,
)
from app.vision.segments import Segments


def npy() -> bytes:
    file = io.BytesIO()
    np.save(file, np.zeros(3))
    return file.getvalue()


def zipped() -> bytes:
    file = io.BytesIO()
    np.savez(file, offset=np.zeros(3))
    return file.getvalue()


def info(name: str, **fields) -> SplitImageInfo:
    return SplitImageInfo(name, 1000, 1000, **fields)


def below(points: np.ndarray, by: float) -> np.ndarray:
    return points + np.array([0.0, by])


@pytest.fixture
def images(line) -> list[ScoredImage]:
    """Three images of two sources: a hit and a short piece; a miss, a hit and a false alarm; nothing at all."""
    one, two, unsure = line(300), line(200, 40, (300.0, 300.0)), line(250, 90, (900.0, 500.0))
    return [
        ScoredImage(
            info("a", source="KITTI", sequence="s"),
            ground_truth(Segments.from_list([one]), Segments.from_list([unsure])),
            Segments.from_list([one[:40], below(one, 1), unsure], [0.1, 0.9, 0.8]),
        ),
        ScoredImage(
            info("b", source="KITTI", sequence="s"),
            ground_truth(Segments.from_list([one, two])),
            Segments.from_list([two, line(150, 0, (200.0, 800.0))], [0.7, 0.6]),
        ),
        ScoredImage(info("c"), ground_truth(Segments.empty()), Segments.empty()),
    ]


def test_a_record_says_everything_of_every_submitted_prediction(images: list[ScoredImage]) -> None:
    record, _, _ = score_part(images, min_length=50)
    assert record.prediction_outcomes.tolist() == [Outcome.IGNORED, Outcome.HIT, Outcome.IGNORED]
    assert record.label_outcomes.tolist() == [Outcome.HIT, Outcome.IGNORED]
    assert record.best_label.tolist() == [-1, 0, 1]
    assert record.liou[1:] == pytest.approx([1, 1], abs=1e-9)
    assert record.offset[1] == pytest.approx(1.0)
    assert record.angle[1] == pytest.approx(0.0, abs=1e-9)
    assert np.isnan(record.offset[[0, 2]]).all()
    assert record.prediction_errors.tolist() == [ErrorType.NONE] * 3


def test_the_matched_label_is_told_though_another_fits_better(line) -> None:
    """Two predictions want the same label; one of them has to take the label beside it."""
    labels = [line(200), below(line(200), 2.5)]
    predictions = [line(200), below(line(200), 0.2)]
    image = ScoredImage(info("a"), ground_truth(Segments.from_list(labels)), Segments.from_list(predictions))
    (record,) = score_part([image])
    assert sorted(record.best_label.tolist()) == [0, 1]


@pytest.mark.parametrize("protocol", [clearlines_v2, official_v1, official_v1_fixed])
def test_the_tallies_are_those_of_each_protocol(images: list[ScoredImage], protocol) -> None:
    for image, record in zip(images, score_part(images, min_length=50), strict=True):
        alone = protocol.score_image(image.truth, long_enough(image.predictions, 50))
        assert np.array_equal(record.tallies[protocol.PROTOCOL], alone.tallies)


def test_a_record_goes_through_npz_and_pickle(images: list[ScoredImage]) -> None:
    for record in score_part(images):
        for copy in (ImageRecord.from_npz(record.as_npz()), pickle.loads(pickle.dumps(record))):
            assert copy.metrics() == record.metrics()
            for name in ("prediction_outcomes", "best_label", "liou", "offset", "angle", "label_errors", "strata"):
                assert np.array_equal(getattr(copy, name), getattr(record, name), equal_nan=name in ("offset", "angle"))
                assert getattr(copy, name).dtype == getattr(record, name).dtype
            assert copy.ranked is not None
            assert record.ranked is not None
            assert np.array_equal(copy.ranked.hit, record.ranked.hit)
            assert copy.ranked.labels == record.ranked.labels


def test_predictions_without_scores_have_no_ranking(images: list[ScoredImage]) -> None:
    image = images[0]
    bare = ScoredImage(image.info, image.truth, Segments(image.predictions.points, image.predictions.offsets))
    (record,) = score_part([bare])
    assert ImageRecord.from_npz(record.as_npz()).ranked is None
    assert "ap" not in measure_of([record])(np.ones((1, 1)))


@pytest.mark.parametrize("data", [b"", b"PK\x03\x04", b"no record", npy(), zipped()])
def test_what_is_no_record_is_refused(data: bytes) -> None:
    with pytest.raises(InvalidFile, match="record"):
        ImageRecord.from_npz(data)


def test_a_record_with_pickled_content_is_refused(tmp_path) -> None:
    file = tmp_path / "evil.npz"
    np.savez(file, prediction_outcomes=np.array([{}], dtype=object))
    with pytest.raises(InvalidFile):
        ImageRecord.from_npz(file.read_bytes())


def test_the_metrics_of_an_image_are_json(images: list[ScoredImage]) -> None:
    first, _, empty = (json.loads(json.dumps(record.metrics(), allow_nan=False)) for record in score_part(images, 50))
    assert (first["tp"], first["fp"], first["fn"], first["f1"]) == (1, 0, 0, 1)
    assert first["offset_mean"] == pytest.approx(1)
    assert first["official_recall"] == 1
    assert (empty["f1"], empty["offset_mean"]) == (1, None)


def test_the_totals_are_json_with_an_interval_around_every_value(images: list[ScoredImage]) -> None:
    found = score_totals([image.info for image in images], score_part(images, 50), draws=200)
    found = json.loads(json.dumps(found, allow_nan=False))
    totals = found["protocols"]["clearlines-v2"]["totals"]
    assert totals["f1"]["value"] == pytest.approx(2 * 2 / (2 * 2 + 1 + 1))
    assert totals["f1"]["low"] <= totals["f1"]["value"] <= totals["f1"]["high"]
    assert (totals["tp"], totals["fp"]["value"]) == ({"value": 2, "low": None, "high": None}, 1)
    assert 0 < totals["ap"]["value"] < 1
    assert totals["calibration_rms"]["value"] is None
    assert found["protocols"]["official-v1"]["totals"]["official_recall"]["value"] == pytest.approx(1.5 / 3)
    assert set(found["protocols"]) == {"official-v1", "official-v1-fixed", "clearlines-v2"}
    assert (found["images"], found["clusters"], found["draws"]) == (3, 2, 200)
    grid = np.array(found["f1_grid"]["f1"])
    assert grid.shape == (len(found["f1_grid"]["taus"]), len(found["f1_grid"]["thresholds"]))
    assert totals["mean_f1"]["value"] == pytest.approx(grid.mean())


def test_strata_and_error_types_add_up_to_the_counts(images: list[ScoredImage]) -> None:
    found = score_totals([image.info for image in images], score_part(images, 50), draws=20)
    totals = found["protocols"]["clearlines-v2"]["totals"]
    for strata in found["strata"].values():
        for key in ("tp", "fp", "fn"):
            assert sum(stratum[key] for stratum in strata) == totals[key]["value"]
    assert [(stratum["name"], stratum["images"]) for stratum in found["strata"]["source"]] == [
        ("KITTI", 2),
        ("unknown", 1),
    ]
    errors = found["error_types"]
    assert sum(errors.values()) == totals["fp"]["value"] + totals["fn"]["value"]
    assert (errors["background"], errors["missed"]) == (1, 1)


def test_parts_may_be_scored_in_any_cut(images: list[ScoredImage]) -> None:
    infos = [image.info for image in images]
    whole = score_totals(infos, score_part(images), draws=50)
    cut = [record for image in images for record in score_part([image])]
    assert score_totals(infos, cut, draws=50) == whole


def test_an_image_with_too_much_line_to_sample_is_named() -> None:
    there_and_back = np.stack([np.tile([0.0, 3e6], 2), np.zeros(4)], axis=1)
    image = ScoredImage(info("street 7"), ground_truth(Segments.empty()), Segments.from_list([there_and_back]))
    with pytest.raises(TooLarge, match="street 7, predictions"):
        score_part([image])


def test_one_record_per_image_is_needed(images: list[ScoredImage]) -> None:
    with pytest.raises(InvalidInput, match="1 records don't go with 3 images"):
        score_totals([image.info for image in images], score_part(images[:1]))
    with pytest.raises(InvalidInput):
        score_totals([], [])


def test_images_are_calibrated_camera_by_camera(images: list[ScoredImage]) -> None:
    def of_camera(camera: str | None, width: int = 1000, **fields) -> ScoredImage:
        image = images[0]
        return ScoredImage(SplitImageInfo("x", width, 1000, camera=camera, **fields), image.truth, image.predictions)

    K = [[900.0, 0, 500], [0, 900, 500], [0, 0, 1]]
    scores = score_cameras(
        [
            of_camera("right"),
            of_camera("left", reference={"K": K, "D": [0.0, 0, 0, 0]}),
            of_camera(None),
            of_camera("left"),
            of_camera("odd", reference={"K": K, "D": [0.0] * 8}),
        ]
    )
    assert [(score.camera, score.images) for score in scores] == [("left", 2), ("odd", 1), ("right", 1)]
    assert [score.grid is None for score in scores] == [False, True, True]
