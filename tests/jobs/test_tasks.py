"""What a worker does, without one."""

from __future__ import annotations

import copyreg
import pickle

import cv2
import numpy as np
import pytest

from app.errors import ClearLinesError, InvalidImage, TooLarge
from app.formats.npz import read_npz
from app.jobs import tasks
from app.jobs.tasks import detect_task, estimate_task, judge_task
from app.vision.distortion import DistortionEstimate
from app.vision.segments import Segments

OPTIONS = {"alone": False, "discard": False, "max_pixels": 1_000_000}
SIZE = (160, 120)


def bars() -> bytes:
    pixels = np.full((SIZE[1], SIZE[0]), 40, np.uint8)
    pixels[30:60, 10:150] = 200
    return cv2.imencode(".png", pixels)[1].tobytes()


def test_detection_gives_candidates_and_what_the_lens_is_read_off() -> None:
    found = detect_task(bars(), "bars", {"min_length": 100}, **OPTIONS)
    assert len(found.candidates) >= 2
    assert found.candidates.extents().min() >= 100
    assert found.candidates.scores is not None
    assert found.milliseconds > 0
    assert (found.judgement, found.distortion) == (None, None)
    assert found.lens_segments is not None
    assert len(read_npz(found.lens_segments).segments) >= len(found.candidates)


def test_an_image_alone_is_judged_at_once() -> None:
    found = detect_task(bars(), "bars", {"min_length": 50}, **{**OPTIONS, "alone": True})
    assert found.lens_segments is None
    assert found.distortion is not None
    assert (found.distortion["width"], found.distortion["height"]) == SIZE
    assert found.judgement is not None
    assert found.judgement.straightness.shape == found.judgement.residuals.shape == (len(found.candidates),)
    assert (found.judgement.straightness > 0.5).all()
    assert found.judgement.residuals.max() < 0.5


def test_discarding_keeps_what_passes() -> None:
    judged = detect_task(bars(), "bars", {"min_length": 30}, **{**OPTIONS, "alone": True})
    kept = detect_task(bars(), "bars", {"min_length": 30}, **{**OPTIONS, "alone": True, "discard": True})
    assert judged.judgement is not None
    assert kept.judgement is not None
    assert len(kept.candidates) == (judged.judgement.straightness >= 0.5).sum() == len(kept.judgement.residuals)


def test_a_constant_image_has_no_candidates() -> None:
    content = cv2.imencode(".png", np.full((50, 60), 99, np.uint8))[1].tobytes()
    for alone in (False, True):
        assert len(detect_task(content, "grey", {}, **{**OPTIONS, "alone": alone}).candidates) == 0


def test_no_segments_give_a_refused_estimate() -> None:
    fields = estimate_task([], SIZE)
    assert (fields["accepted"], fields["width"], fields["height"]) == (False, *SIZE)
    assert fields["reasons"]


def test_a_bent_segment_is_told_from_a_straight_one() -> None:
    x = np.arange(10.0, 150.0)
    straight = np.stack([x, 40 + 0.1 * x], axis=1)
    bent = np.stack([x, 60 + 0.004 * (x - 80) ** 2], axis=1)
    flat = {**estimate_task([], SIZE), "accepted": True, "reasons": [], "uncertainty": {"pred": 0.0, "sd": 0.0}}
    flat["uncertainty"] = dict.fromkeys(estimate_task([], SIZE)["uncertainty"], 0.0)
    judged = judge_task(Segments.from_list([straight, bent]), flat)
    assert judged.straightness[0] > 0.9
    assert judged.straightness[1] < 0.1
    assert judged.residuals[0] < 0.001
    # a parabola c (x - m)^2 over a chord L deviates by c L^2 / (6 sqrt 5) RMS from its line
    assert judged.residuals[1] == pytest.approx(0.004 * 139**2 / (6 * np.sqrt(5)), rel=0.05)


def test_nothing_to_judge() -> None:
    judged = judge_task(Segments.empty(), estimate_task([], SIZE))
    assert judged.straightness.shape == judged.residuals.shape == (0,)


def test_a_broken_file_says_which_one_it_is() -> None:
    with pytest.raises(InvalidImage) as caught:
        detect_task(bars()[:100], "street/7", {}, **OPTIONS)
    assert pickle.loads(pickle.dumps(caught.value)).as_dict() == caught.value.as_dict()
    assert caught.value.where


def test_too_many_pixels_are_refused_before_they_are_decoded() -> None:
    with pytest.raises(ClearLinesError) as caught:
        detect_task(bars(), "bars", {}, **{**OPTIONS, "max_pixels": 1000})
    assert caught.value.status in (413, 422)


class Unpicklable(Exception):
    def __init__(self, first: int, second: int) -> None:
        super().__init__(f"{first}/{second}")


@pytest.mark.parametrize(("raised", "told"), [(Unpicklable(1, 2), ClearLinesError), (MemoryError(), TooLarge)])
def test_any_error_leaves_the_worker_as_one_of_ours(monkeypatch, caplog, raised, told) -> None:
    def fail(*_args: object) -> None:
        raise raised

    monkeypatch.setattr(tasks, "detect_for_prelabel", fail)
    with pytest.raises(told) as caught:
        detect_task(bars(), "bars", {}, **OPTIONS)
    # Dask's tblib, where another test has imported it, pickles what the error came of too; a pool's workers have none
    monkeypatch.delitem(copyreg.dispatch_table, told, raising=False)
    travelled = pickle.loads(pickle.dumps(caught.value))
    assert (type(travelled), travelled.where) == (told, "bars")
    assert travelled.hint


def test_estimates_can_be_read_back() -> None:
    assert not DistortionEstimate.from_dict(estimate_task([], SIZE)).accepted
