"""Features on request and in the background, and trainings, in threads: the real tasks, nothing is killed."""

from __future__ import annotations

import threading
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, Executor, ThreadPoolExecutor
from typing import Any
from uuid import uuid4

import numpy as np
import pytest
from sqlalchemy import select

from app.db.models import Dataset, Image, ImageFeatures, Segment, SuggestionModel, SuggestionTraining
from app.errors import InvalidImage, NotFound, Unavailable
from app.formats.labelled import LabelledSegments
from app.jobs import feature_desk as module
from app.jobs.feature_desk import FeatureDesk
from app.jobs.suggestion_learning import train_task
from app.jobs.suggestion_tasks import CandidateFacts, features_task
from app.jobs.work import Tasks
from app.review.features import FEATURES
from app.services.candidates import refresh_counts
from app.services.deciding import decide
from app.services.decision_batch import Wish
from app.services.labels import segment_rows
from app.services.suggestion_features import feature_inputs, images_without_features, unpacked
from app.services.suggestion_training import FEWEST_DECISIONS, ask_for_training
from app.vision.segments import Segments

MAX_PIXELS = 1_000_000
Eventually = Callable[[Callable[[], Any], str], Any]


def in_threads(workers: int) -> Executor:
    return ThreadPoolExecutor(workers)


def prelabel(yard, *names: str) -> list[int]:
    """Pre-label new images; return their ids."""
    yard.add(*names)
    yard.start()
    yard.dispatcher(executors=in_threads).run_until_idle()
    with yard.database.read() as session:
        return list(session.scalars(select(Image.id).where(Image.name.in_(names)).order_by(Image.id)))


def desk(yard, task: Callable[..., CandidateFacts] = features_task) -> FeatureDesk:
    return FeatureDesk(yard.database, yard.blobs, MAX_PIXELS, yard.now, executors=ThreadPoolExecutor, task=task)


class Counting:
    """Stands before the real task and notes for which image it was asked; may hold it up."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self.gate = threading.Event()
        self.gate.set()

    def __call__(self, content: bytes, name: str, *arguments: Any, **options: Any) -> CandidateFacts:
        self.names.append(name)
        assert self.gate.wait(60)
        return features_task(content, name, *arguments, **options)


def test_features_are_computed_once_and_stored(yard) -> None:
    [image_id] = prelabel(yard, "a")
    counting = Counting()
    features = desk(yard, counting)
    first = features.features_of(image_id)
    again = features.features_of(image_id)
    features.stop()
    assert counting.names == ["a"]
    assert first.features.shape == (len(first.segment_ids), len(FEATURES))
    assert len(first.segment_ids) >= 3
    assert np.isfinite(first.features[:, FEATURES.index("contrast")]).all()
    np.testing.assert_array_equal(again.features, first.features)


def test_those_who_ask_at_once_share_one_computation(small_yard, eventually: Eventually) -> None:
    [image_id] = prelabel(small_yard, "a")
    counting = Counting()
    counting.gate.clear()
    features = desk(small_yard, counting)
    with ThreadPoolExecutor(3) as askers:
        answers = [askers.submit(features.features_of, image_id) for _ in range(3)]
        eventually(lambda: counting.names, "somebody asks")
        counting.gate.set()
        found = [answer.result(60).segment_ids.tolist() for answer in answers]
    features.stop()
    assert found[0] == found[1] == found[2]
    assert set(counting.names) == {"a"}


def test_too_many_images_at_once_are_refused(
    small_yard, monkeypatch: pytest.MonkeyPatch, eventually: Eventually
) -> None:
    first, second = prelabel(small_yard, "a", "b")
    monkeypatch.setattr(module, "MOST_AT_ONCE", 1)
    counting = Counting()
    counting.gate.clear()
    features = desk(small_yard, counting)
    with ThreadPoolExecutor(1) as askers:
        answer = askers.submit(features.features_of, first)
        eventually(lambda: counting.names, "the first one is under way")
        with pytest.raises(Unavailable, match="other images"):
            features.features_of(second)
        counting.gate.set()
        answer.result(60)
    assert len(features.features_of(second).segment_ids)
    features.stop()


def test_what_takes_too_long_or_dies_is_said(small_yard, monkeypatch: pytest.MonkeyPatch) -> None:
    [image_id] = prelabel(small_yard, "a")
    counting = Counting()
    counting.gate.clear()
    features = desk(small_yard, counting)
    monkeypatch.setattr(module, "LONGEST_WAIT", 0.01)
    with pytest.raises(Unavailable, match="takes long"):
        features.features_of(image_id)
    counting.gate.set()
    features.stop()

    def dies(*_arguments: Any, **_options: Any) -> CandidateFacts:
        raise BrokenExecutor

    with pytest.raises(Unavailable, match="killed"):
        desk(small_yard, dies).features_of(image_id)
    with pytest.raises(NotFound):
        desk(small_yard).features_of(image_id + 1)


def test_an_image_that_cannot_be_read_has_the_features_of_its_lines(small_yard) -> None:
    [image_id] = prelabel(small_yard, "a")
    with small_yard.database.read() as session:
        inputs = feature_inputs(session, image_id)
    facts = features_task(
        b"no image",
        "a",
        inputs.segments,
        inputs.size,
        residuals=inputs.residuals,
        straightness=inputs.straightness,
        distortion={"k": [0.1]},
        before=None,
        after=None,
        max_pixels=MAX_PIXELS,
    )
    assert np.isnan(facts.features[:, FEATURES.index("contrast")]).all()
    assert np.isfinite(facts.features[:, FEATURES.index("length")]).all()


def test_the_dispatcher_describes_images_when_nothing_else_is_to_do(yard, eventually: Eventually) -> None:
    prelabel(yard, "a", "b")
    with yard.database.read() as session:
        assert len(images_without_features(session, 9)) == 2
    dispatcher = yard.dispatcher(executors=in_threads)
    dispatcher.start()
    try:
        eventually(lambda: not without_features(yard), "all are described")
    finally:
        dispatcher.stop()
    with yard.database.read() as session:
        contents = session.scalars(select(ImageFeatures.content)).all()
    assert all(np.isfinite(unpacked(content).features[:, 0]).all() for content in contents)


def without_features(yard) -> list[int]:
    with yard.database.read() as session:
        return images_without_features(session, 9)


def test_an_image_that_cannot_be_described_is_left_alone(small_yard, eventually: Eventually) -> None:
    prelabel(small_yard, "a", "b")

    def fails_on_a(content: bytes, name: str, *arguments: Any, **options: Any) -> CandidateFacts:
        if name == "a":
            raise InvalidImage("broken")
        return features_task(content, name, *arguments, **options)

    dispatcher = small_yard.dispatcher(Tasks(features=fails_on_a), executors=in_threads)
    dispatcher.start()
    try:
        eventually(lambda: not without_features(small_yard), "both are through")
    finally:
        dispatcher.stop()
    with small_yard.database.read() as session:
        rows = session.execute(select(Image.name, ImageFeatures.content).join(ImageFeatures)).all()
    known = {name: np.isfinite(unpacked(content).features).any() for name, content in rows}
    assert known == {"a": False, "b": True}


def judge_all(yard, image_ids: list[int], kept: Callable[[int], bool]) -> None:
    with yard.database.write() as session:
        for image_id in image_ids:
            ids = session.scalars(select(Segment.id).where(Segment.image_id == image_id).order_by(Segment.id)).all()
            wishes = [
                Wish(str(uuid4()), str(uuid4()), key, "keep" if kept(number) else "reject")
                for number, key in enumerate(ids)
            ]
            decide(session, image_id, wishes, person="Ann", now=yard.now())


def enough_decided(yard) -> None:
    """Judge as many candidates as a training takes, on two images: upright ones are kept."""
    count = FEWEST_DECISIONS // 2
    along = np.linspace(10, 110, 30)
    lines = [
        np.stack([np.full(30, 5.0 + 7 * row), along] if row % 2 else [along, np.full(30, 5.0 + 5 * row)], axis=1)
        for row in range(count)
    ]
    yard.add("a", "b")
    with yard.database.write() as session:
        ids = session.scalars(select(Image.id)).all()
        for image_id in ids:
            rows = segment_rows(image_id, LabelledSegments(Segments.from_list(lines)))
            for row in rows:
                row.origin = "pipeline"
            session.add_all(rows)
        refresh_counts(session, ids)
    judge_all(yard, list(ids), lambda number: number % 2 == 1)


def models(yard) -> list[SuggestionModel]:
    with yard.database.read() as session:
        return list(session.scalars(select(SuggestionModel).order_by(SuggestionModel.id)))


def test_a_model_is_learnt_in_the_background(yard, eventually: Eventually) -> None:
    enough_decided(yard)
    dispatcher = yard.dispatcher(executors=in_threads)
    dispatcher.start()
    try:
        [model] = eventually(lambda: models(yard), "it is learnt")
    finally:
        dispatcher.stop()
    assert (model.n_decisions, model.n_images) == (FEWEST_DECISIONS, 2)
    assert model.report["thresholds"]["reject"] <= model.report["thresholds"]["keep"]
    assert len(model.report["gain"]) == model.n_images


def test_what_cannot_be_learnt_is_said_once(small_yard, eventually: Eventually) -> None:
    enough_decided(small_yard)
    tried: list[int] = []

    def fails(features: np.ndarray, *_arguments: Any) -> Any:
        tried.append(len(features))
        raise InvalidImage("it can't be learnt")

    with small_yard.database.write() as session:
        ask_for_training(session, session.scalars(select(Dataset)).one(), small_yard.now())
    dispatcher = small_yard.dispatcher(Tasks(train=fails), executors=in_threads)
    dispatcher.start()
    try:
        error = eventually(lambda: training_error(small_yard), "it failed")
    finally:
        dispatcher.stop()
    assert error["message"] == "it can't be learnt"
    assert len(tried) == 1
    assert models(small_yard) == []


def training_error(yard) -> dict[str, Any] | None:
    with yard.database.read() as session:
        return session.scalar(select(SuggestionTraining.error))


def test_one_verdict_alone_teaches_the_general_model() -> None:
    features = np.zeros((50, len(FEATURES)), np.float32)
    trained = train_task(features, np.ones(50, bool), np.repeat([0, 1], 25))
    assert trained.report["calibration"] is None
    assert [entry["images"] for entry in trained.report["gain"]] == [0, 1]
