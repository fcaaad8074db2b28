from __future__ import annotations

import numpy as np
import pytest

from app.errors import InvalidInput
from app.evaluation import PROTOCOLS, SCORER_VERSION, clearlines_v2, ground_truth, official_v1, protocol_named, total
from app.vision.segments import Segments


@pytest.fixture(scope="module")
def images(line):
    """Five images: truth and predictions with scores."""
    random = np.random.default_rng(11)
    made = []
    for _ in range(5):
        labels = [line(random.uniform(60, 200), random.uniform(0, 180), random.uniform(200, 700, 2)) for _ in range(9)]
        found = [label + random.normal(0, 1.2, 2) for label in labels[:7]] + [line(80, 10, (50.0, 50.0))]
        made.append((ground_truth(Segments.from_list(labels)), Segments.from_list(found, random.random(len(found)))))
    return made


@pytest.mark.parametrize("name", PROTOCOLS)
def test_totals_of_weighted_images_are_those_of_repeated_ones(images, name) -> None:
    protocol = protocol_named(name)
    scores = [protocol.score_image(truth, predictions) for truth, predictions in images]
    tallies = np.stack([score.tallies for score in scores])
    assert tallies.shape == (5, protocol.layout.size)
    ranked = [getattr(score, "ranked", None) for score in scores]
    weights = np.array([[1, 1, 1, 1, 1], [2, 0, 1, 0, 2], [0, 0, 5, 0, 0]])
    together = total(protocol, tallies, ranked, weights)
    for draw, weight in enumerate(weights):
        chosen = np.repeat(np.arange(5), weight)
        alone = total(protocol, tallies[chosen], [ranked[index] for index in chosen])
        assert set(alone) == set(together)
        for metric, value in alone.items():
            assert together[metric][draw] == pytest.approx(value, nan_ok=True), metric
    assert total(protocol, tallies, ranked, weights[1])[protocol.key] == together[protocol.key][1]
    assert set(together) - {"ap"} == set(protocol.metric_names)
    assert ("ap" in together) == (name == "clearlines-v2")
    assert protocol.key in protocol.metric_names


def test_average_precision_is_absent_where_one_image_has_no_ranking(images) -> None:
    protocol = protocol_named("clearlines-v2")
    truth, predictions = images[0]
    with_scores = clearlines_v2.score_image(truth, predictions)
    without = clearlines_v2.score_image(truth, Segments(predictions.points, predictions.offsets))
    tallies = np.stack([with_scores.tallies, without.tallies])
    assert tallies[0].tolist() == tallies[1].tolist()
    assert "ap" in total(protocol, tallies[:1], [with_scores.ranked])
    assert "ap" not in total(protocol, tallies, [with_scores.ranked, without.ranked])
    assert "ap" not in total(protocol, tallies)


def test_official_totals_are_those_of_the_protocol_itself(images) -> None:
    scores = [official_v1.score_image(truth, predictions) for truth, predictions in images]
    expected = official_v1.total(scores)
    found = total(protocol_named("official-v1"), np.stack([score.tallies for score in scores]))
    for metric, value in (("precision", expected.precision), ("recall", expected.recall), ("f1", expected.f1)):
        assert found[f"official_{metric}"] == pytest.approx(value, rel=0, abs=1e-12)


@pytest.mark.parametrize(
    ("tallies", "weights"),
    [(np.zeros((0, 4)), None), (np.zeros((2, 3)), None), (np.zeros((2, 4)), np.ones(3)), (np.zeros((2, 4)), 1.0)],
)
def test_shapes_that_don_t_fit_are_refused(tallies, weights) -> None:
    with pytest.raises(InvalidInput, match="have shape"):
        total(protocol_named("official-v1"), tallies, weights=weights)


def test_protocols_are_named_and_versioned() -> None:
    assert list(PROTOCOLS) == ["official-v1", "official-v1-fixed", "clearlines-v2"]
    assert [protocol.name for protocol in PROTOCOLS.values()] == list(PROTOCOLS)
    assert all(protocol.version and protocol.description for protocol in PROTOCOLS.values())
    assert SCORER_VERSION
    with pytest.raises(InvalidInput, match="no protocol 'coco'"):
        protocol_named("coco")
