"""Suggestions: features that are stored, decisions that teach, models that are learnt, and what they suggest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from datetime import timedelta
from uuid import uuid4

import numpy as np
import pytest

from app.db.models import Dataset, Image, Segment, SuggestionModel, SuggestionTraining
from app.errors import Conflict, NotFound
from app.review.features import FEATURE_VERSION, FEATURES
from app.review.learning_curve import PRIOR_THRESHOLDS
from app.review.prior import prior_model
from app.services.deciding import decide
from app.services.decision_batch import Wish
from app.services.reviews import set_review
from app.services.suggestion_examples import images_to_describe, training_examples
from app.services.suggestion_features import (
    FeatureInputs,
    KnownFeatures,
    feature_inputs,
    images_without_features,
    known_features,
    packed,
    store_features,
    unpacked,
)
from app.services.suggestion_models import model_of
from app.services.suggestion_reports import dataset_suggestions
from app.services.suggestion_training import (
    FEWEST_DECISIONS,
    PAUSE_AFTER_FAILURE,
    TrainingDue,
    ask_for_training,
    fail_training,
    next_training,
    store_model,
    training_due,
)
from app.services.suggestions import suggestions_of_image


def features_for(inputs: FeatureInputs, score: Sequence[float] | None = None) -> KnownFeatures:
    """Unknown features, but for the score."""
    count = len(inputs.segment_ids)
    table = np.full((count, len(FEATURES)), np.nan, np.float32)
    if score is not None:
        table[:, FEATURES.index("score")] = score
    return KnownFeatures(inputs.segment_ids, table, np.arange(count) // 2, np.linspace(0, 1, count))


def describe(place, image_id: int, score: Sequence[float] | None = None) -> KnownFeatures:
    with place.database.write() as session:
        inputs = feature_inputs(session, image_id)
        known = features_for(inputs, score)
        assert store_features(session, inputs, known, place.now)
        return known


def judge(place, image_id: int, verdicts: Sequence[str], *, kind: str = "judge") -> list[int]:
    """Decide on the first segments of an image; return all of them."""
    with place.database.write() as session:
        ids = [row.id for row in session.query(Segment).filter_by(image_id=image_id).order_by(Segment.ordinal)]
        group = str(uuid4())
        wishes = [Wish(str(uuid4()), group, key, verdict, kind) for key, verdict in zip(ids, verdicts, strict=False)]
        decide(session, image_id, wishes, person="Ann", now=place.now)
        return ids


def dataset_id(place, slug: str) -> int:
    with place.database.read() as session:
        return place.find(session, slug).id


def known(place, image_id: int) -> KnownFeatures | None:
    with place.database.read() as session:
        return known_features(session, session.get_one(Image, image_id))


def next_due(place) -> TrainingDue | None:
    with place.database.read() as session:
        return next_training(session)


def learnt(place, due: TrainingDue) -> int:
    report = {"thresholds": {"keep": 0.7, "reject": 0.1}, "calibration": None, "gain": [], "weights": []}
    with place.database.write() as session:
        model = store_model(session, due, FEATURE_VERSION, prior_model().as_dict(), report, place.now)
        assert model is not None
        return model.id


def test_features_are_found_again_until_the_candidates_change(place) -> None:
    slug = place.dataset()
    [image_id] = place.images(slug, "a")
    place.run([image_id], candidates=4)
    assert known(place, image_id) is None
    with place.database.read() as session:
        assert images_without_features(session, 9) == [image_id]
    given = describe(place, image_id, [1, 2, 3, 4])
    found = known(place, image_id)
    assert found is not None
    np.testing.assert_array_equal(found.features, given.features)
    assert found.segment_ids.tolist() == given.segment_ids.tolist()
    assert found.families.tolist() == [0, 0, 1, 1]
    assert found.lens_information == pytest.approx([0, 1 / 3, 2 / 3, 1])
    with place.database.write() as session:
        assert images_without_features(session, 9) == []
        session.get_one(Image, image_id).revision += 1
    assert known(place, image_id) is None


def test_features_of_earlier_candidates_are_not_stored(place) -> None:
    slug = place.dataset()
    [image_id] = place.images(slug, "a")
    place.run([image_id], candidates=2)
    with place.database.write() as session:
        inputs = replace(feature_inputs(session, image_id), revision=-1)
        assert not store_features(session, inputs, features_for(inputs), place.now)
    assert known(place, image_id) is None


def test_another_frame_beside_it_makes_features_anew(place) -> None:
    slug = place.dataset()
    first, second = (place.image(slug, name, sequence="drive") for name in ("a", "b"))
    other = place.image(slug, "c")
    place.run([first], candidates=3)
    describe(place, first)
    assert known(place, first) is not None
    place.run([second, other], candidates=2)
    assert known(place, first) is None
    with place.database.read() as session:
        inputs = feature_inputs(session, first)
        assert inputs.before is None
        assert inputs.after is not None
        assert len(inputs.after) == 2
        assert feature_inputs(session, other).after is None


def test_what_is_known_of_candidates_goes_along(sqlite_place) -> None:
    place = sqlite_place
    slug = place.dataset()
    [image_id] = place.images(slug, "a")
    place.run([image_id], candidates=3)
    with place.database.write() as session:
        row = session.query(Segment).filter_by(image_id=image_id).order_by(Segment.ordinal).first()
        row.score, row.residual, row.straightness = 0.25, 1.5, 0.75
    with place.database.read() as session:
        inputs = feature_inputs(session, image_id)
        with pytest.raises(NotFound):
            feature_inputs(session, image_id + 1)
    assert inputs.segments.scores is not None
    assert [inputs.segments.scores[0], inputs.residuals[0], inputs.straightness[0]] == [0.25, 1.5, 0.75]
    assert np.isnan(inputs.residuals[1:]).all()
    assert np.isnan(inputs.segments.scores[1:]).all()


def test_packed_features_hold_no_objects() -> None:
    table = np.arange(2 * len(FEATURES), dtype=np.float32).reshape(2, -1)
    again = unpacked(packed(KnownFeatures(np.array([7, 9]), table, np.array([-1, 0]), np.array([0.5, 1]))))
    np.testing.assert_array_equal(again.features, table)
    assert again.families.tolist() == [-1, 0]
    stream = np.array([{"a": 1}], dtype=object)
    broken = KnownFeatures(stream, table, np.array([0]), np.array([0.0]))
    with pytest.raises(ValueError, match="allow_pickle"):
        unpacked(packed(broken))


def test_an_image_teaches_once_all_is_decided(place) -> None:
    slug = place.dataset()
    first, second, third = place.images(slug, "a", "b", "c")
    place.run([first, second, third], candidates=4)
    judge(place, first, ["keep", "reject", "ambiguous"])
    judge(place, second, ["keep", "reject", "reject", "reject"], kind="accept")
    judge(place, third, ["keep"] * 4)
    with place.database.write() as session:
        set_review(session, third, "discarded", now=place.now, reason="blurred")
    describe(place, second, [3, 0, 0, 0])
    key = dataset_id(place, slug)
    with place.database.read() as session:
        due = training_due(session, key)
        examples = training_examples(session, key)
    assert (due.n_decisions, due.n_images) == (4, 1)
    assert examples.kept.tolist() == [True, False, False, False]
    judge(place, first, ["keep", "reject", "ambiguous", "keep"])
    with place.database.read() as session:
        due = training_due(session, key)
        assert session.scalars(images_to_describe(key)).all() == [first]
        # what isn't described yet can't teach
        assert len(training_examples(session, key).kept) == 4
    assert (due.n_decisions, due.n_images) == (7, 2)  # ambiguous is neither
    describe(place, first, [3, 0, 1, 3])
    with place.database.read() as session:
        examples = training_examples(session, key)
    assert sorted(examples.kept.tolist()) == [False] * 4 + [True] * 3
    score = examples.features[:, FEATURES.index("score")]
    assert ((score > 2) == examples.kept).all()
    assert set(examples.image_index.tolist()) == {0, 1}


def test_the_image_finished_first_comes_first(sqlite_place) -> None:
    place = sqlite_place
    slug = place.dataset()
    first, second = place.images(slug, "a", "b")
    place.run([first, second], candidates=3)
    for image_id, verdict, later in ((first, "keep", 2), (second, "reject", 1)):
        judge(place, image_id, [verdict] * 3)
        describe(place, image_id)
        with place.database.write() as session:
            set_review(session, image_id, "done", now=place.now + timedelta(hours=later))
    with place.database.read() as session:
        examples = training_examples(session, place.find(session, slug).id)
    assert examples.image_index.tolist() == [0, 0, 0, 1, 1, 1]
    assert examples.kept.tolist() == [False] * 3 + [True] * 3


def test_imported_verdicts_and_drawn_segments_teach_nothing(sqlite_place) -> None:
    place = sqlite_place
    slug = place.dataset()
    imported, drawn = place.images(slug, "a", "b")
    place.label(imported, ["keep", "reject"])
    place.run([drawn], candidates=2)
    with place.database.write() as session:
        for row in session.query(Segment).filter_by(image_id=drawn):
            row.origin = "manual"
    judge(place, drawn, ["keep", "keep"])
    with place.database.read() as session:
        due = training_due(session, place.find(session, slug).id)
    assert (due.n_decisions, due.n_images) == (0, 0)


def test_a_model_is_learnt_when_there_is_enough_new(place) -> None:
    slug = place.dataset()
    first, second, third = place.images(slug, "a", "b", "c")
    place.run([first, second, third], candidates=FEWEST_DECISIONS)
    judge(place, first, ["keep", "reject"] * (FEWEST_DECISIONS // 2 - 1))
    assert next_due(place) is None
    judge(place, first, ["keep", "reject"] * (FEWEST_DECISIONS // 2))
    due = next_due(place)
    assert due is not None
    assert (due.dataset_id, due.n_decisions, due.n_images) == (dataset_id(place, slug), FEWEST_DECISIONS, 1)
    learnt(place, due)
    assert next_due(place) is None
    judge(place, second, ["keep", "reject"] * (FEWEST_DECISIONS // 2))
    later = next_due(place)
    assert later is not None
    assert later.n_decisions == 2 * FEWEST_DECISIONS
    assert later.last_decision_id > due.last_decision_id


def test_who_asks_gets_a_model_from_fewer_new_decisions(place) -> None:
    slug = place.dataset()
    first, second = place.images(slug, "a", "b")
    place.run([first], candidates=FEWEST_DECISIONS)
    place.run([second], candidates=2)
    with place.database.write() as session, pytest.raises(Conflict, match="too few") as caught:
        ask_for_training(session, place.find(session, slug), place.now)
    assert caught.value.details == {"decisions": 0, "images": 0}
    judge(place, first, ["keep", "reject"] * (FEWEST_DECISIONS // 2))
    due = next_due(place)
    assert due is not None
    learnt(place, due)
    judge(place, second, ["keep", "reject"])
    assert next_due(place) is None
    with place.database.write() as session:
        ask_for_training(session, place.find(session, slug), place.now)
    asked = next_due(place)
    assert asked is not None
    assert asked.n_decisions == FEWEST_DECISIONS + 2
    model = learnt(place, asked)
    assert next_due(place) is None
    with place.database.read() as session:
        assert model_of(session, asked.dataset_id).name.id == model


def test_what_isnt_due_is_counted_again_after_the_next_decision(place, count_queries) -> None:
    slug = place.dataset()
    first, second = place.images(slug, "a", "b")
    place.label(first, ["keep"] * FEWEST_DECISIONS)  # imported: enough from above, but nothing to learn from
    place.run([second], candidates=FEWEST_DECISIONS)
    looked_at: dict[int, int] = {}
    numbers = []
    for verdicts in ([], [], ["keep"], ["keep", "reject"] * (FEWEST_DECISIONS // 2)):
        if verdicts:
            judge(place, second, verdicts)
        with place.database.read() as session, count_queries(place.database) as statements:
            due = next_training(session, looked_at)
        numbers.append((len(statements), due is not None))
    once = numbers[1][0]
    assert once == 1
    assert [(number > once, due) for number, due in numbers] == [
        (True, False),
        (False, False),
        (False, False),  # the image isn't whole, so its decisions don't count yet
        (True, True),
    ]


def test_while_the_bound_is_too_low_nothing_is_counted(sqlite_place, count_queries) -> None:
    place = sqlite_place
    slug = place.dataset()
    (image,) = place.images(slug, "a")
    place.run([image], candidates=FEWEST_DECISIONS)
    judge(place, image, ["keep", "reject"] * (FEWEST_DECISIONS // 2))
    due = next_due(place)
    assert due is not None
    learnt(place, due)
    for verdict in ("keep", "reject"):  # each is news, but there is no more to learn from than before
        judge(place, image, [verdict])
        with place.database.read() as session, count_queries(place.database) as statements:
            assert next_training(session, {}) is None
        assert not [each for each in statements if "segment_states" in each]


def test_a_training_that_fails_is_not_tried_at_once(place) -> None:
    slug = place.dataset()
    [image_id] = place.images(slug, "a")
    place.run([image_id], candidates=FEWEST_DECISIONS)
    judge(place, image_id, ["keep", "reject"] * (FEWEST_DECISIONS // 2))
    due = next_due(place)
    assert due is not None
    with place.database.write() as session:
        fail_training(session, due, {"code": "error", "message": "it broke"})
    assert next_due(place) is None
    with place.database.read() as session:
        state = dataset_suggestions(session, place.find(session, slug)).training
    assert state.error == {"code": "error", "message": "it broke"}
    assert not state.asked
    with place.database.write() as session:
        row = session.get_one(SuggestionTraining, due.dataset_id)
        row.failed_decision_id = due.last_decision_id - PAUSE_AFTER_FAILURE
    assert next_due(place) is not None
    with place.database.write() as session:
        row = session.get_one(SuggestionTraining, due.dataset_id)
        row.failed_decision_id = due.last_decision_id
        ask_for_training(session, place.find(session, slug), place.now)
    assert next_due(place) is not None


def test_the_general_model_suggests_until_one_is_learnt(place) -> None:
    slug = place.dataset()
    [image_id] = place.images(slug, "a")
    place.run([image_id], candidates=5)
    given = describe(place, image_id, [-4, -2, 0, 2, 4])
    with place.database.read() as session:
        answer = suggestions_of_image(session, image_id, given)
    assert answer.model.id is None
    assert answer.thresholds == PRIOR_THRESHOLDS
    probability = [each.probability for each in answer.segments]
    assert probability == sorted(probability)
    assert probability[0] < probability[-1]
    assert [each.id for each in answer.segments] == given.segment_ids.tolist()
    assert "score" in answer.segments[-1].speaks_for
    assert "score" in answer.segments[0].speaks_against
    assert all(0 <= each.value <= 1 and 0 <= each.lens <= 1 for each in answer.segments)

    model = learnt(place, TrainingDue(dataset_id(place, slug), 90, 3, 17))
    with place.database.read() as session:
        answer = suggestions_of_image(session, image_id, given)
        page = dataset_suggestions(session, place.find(session, slug))
    assert (answer.model.id, answer.model.decisions, answer.model.images) == (model, 90, 3)
    assert (answer.thresholds.keep, answer.thresholds.reject) == (0.7, 0.1)
    assert page.model == answer.model
    assert page.training.wanted == 130


def test_a_model_of_other_features_is_none(sqlite_place) -> None:
    place = sqlite_place
    slug = place.dataset()
    model = learnt(place, TrainingDue(dataset_id(place, slug), 90, 3, 17))
    with place.database.write() as session:
        session.get_one(SuggestionModel, model).version = "0"
    with place.database.read() as session:
        assert model_of(session, dataset_id(place, slug)).name.id is None
        page = dataset_suggestions(session, place.find(session, slug))
    assert page.calibration is None
    assert page.weights


def test_a_dataset_that_is_gone_learns_nothing(sqlite_place) -> None:
    place = sqlite_place
    due = TrainingDue(4711, 90, 3, 17)
    with place.database.write() as session:
        assert store_model(session, due, FEATURE_VERSION, {}, {}, place.now) is None
        fail_training(session, due, {"code": "error", "message": "it broke"})
        assert session.query(SuggestionTraining).count() == 0
        assert session.get(Dataset, 4711) is None


def test_a_candidate_that_is_replaced_gets_no_suggestion(sqlite_place) -> None:
    place = sqlite_place
    slug = place.dataset()
    [image_id] = place.images(slug, "a")
    place.run([image_id], candidates=3)
    given = describe(place, image_id)
    with place.database.write() as session:
        session.get_one(Segment, int(given.segment_ids[1])).retired_at = place.now
    with place.database.read() as session:
        answer = suggestions_of_image(session, image_id, given)
    assert [each.id for each in answer.segments] == given.segment_ids[[0, 2]].tolist()
