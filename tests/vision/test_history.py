"""How segments came about."""

import numpy as np
import pytest

from app.vision.history import SegmentHistory, detect_with_history
from app.vision.parameters import DetectionParameters
from app.vision.pipeline import detect
from app.vision.scoring import WEIGHTS, score
from app.vision.segments import Segments

PARAMETERS = DetectionParameters(min_length=50)


def along(points: np.ndarray, line: np.ndarray) -> np.ndarray:
    """Coordinates of points along the chord of a polyline."""
    chord = (line[-1] - line[0]).astype(float)
    return (points - line[0]) @ chord / np.hypot(*chord)


@pytest.fixture(scope="module")
def photo(street) -> tuple[Segments, tuple[SegmentHistory, ...], np.ndarray]:
    image = street("P1020816")
    return *detect_with_history(image, PARAMETERS), image


@pytest.fixture(scope="module")
def broken() -> np.ndarray:
    """A dark step along row 40, interrupted by posts in columns 60 to 62 and 130 to 133."""
    image = np.full((80, 200), 160, np.uint8)
    image[:40] = 60
    for first, last in ((60, 63), (130, 134)):
        image[20:60, first:last] = 110
    return image


def test_the_segments_are_those_of_detect(photo, windows: np.ndarray) -> None:
    segments, histories, image = photo
    assert segments == detect(image, PARAMETERS)
    assert len(histories) == len(segments) > 100
    assert detect_with_history(windows)[0] == detect(windows)
    assert [each.score for each in histories] == pytest.approx(segments.scores)


def test_a_segment_that_was_never_broken_is_one_piece(windows: np.ndarray) -> None:
    segments, (history,) = detect_with_history(windows)
    assert history.pieces.shape == (1, 2, 2)
    assert history.gaps.shape == (0, 2, 2)
    assert history.rounds == ()
    assert history.pieces[0] == pytest.approx(segments[0][[0, -1]], abs=3)


def test_a_broken_edge_is_told_piece_by_piece(broken: np.ndarray) -> None:
    segments, histories = detect_with_history(broken)
    assert len(segments) == 1
    history, line = histories[0], segments[0]
    assert len(history.pieces) == 3
    for spans in (history.pieces, history.gaps):
        columns = along(spans.reshape(-1, 2), line)
        assert (np.diff(columns) > 0).all()
    # gaps lie between the pieces
    assert history.gaps[:, 0] == pytest.approx(history.pieces[:-1, 1], abs=0.5)
    assert history.gaps[:, 1] == pytest.approx(history.pieces[1:, 0], abs=0.5)
    assert (history.costs > 0).all()
    assert not history.flipped.any()
    assert set(history.rounds) == {"following"}


def test_an_edge_whose_bright_side_changes_says_so() -> None:
    image = np.full((80, 240), 120, np.uint8)
    image[:40, :120] = 40
    image[:40, 124:] = 200
    image[:, 120:124] = 120
    _, histories = detect_with_history(image, DetectionParameters(min_length=200))
    assert [history.flipped.tolist() for history in histories] == [[True]]
    assert histories[0].rounds == ("flipping",)


def test_histories_of_a_photo_hold_together(photo) -> None:
    segments, histories, _ = photo
    assert sum(len(each.pieces) for each in histories) > 1.3 * len(segments)
    for line, history in zip(segments, histories, strict=True):
        count = len(history.pieces)
        assert history.gaps.shape == (count - 1, 2, 2)
        assert len(history.costs) == len(history.flipped) == len(history.rounds) == count - 1
        begin, end = along(history.pieces.reshape(-1, 2), line)[[0, -1]]
        length = along(line[-1:], line)[0]
        # from the first piece to the last, with what was added and without what was cut
        assert begin - history.extended[0] + history.trimmed[0] == pytest.approx(0, abs=2)
        assert end + history.extended[1] - history.trimmed[1] == pytest.approx(length, abs=2)
        assert min(*history.extended, *history.trimmed) >= 0


def test_every_way_to_change_a_segment_occurs(photo) -> None:
    _, histories, _ = photo
    assert {name for each in histories for name in each.rounds} == {"following", "flipping", "after extension"}
    assert any(each.extended[0] > 5 for each in histories)
    assert any(each.trimmed[0] > 5 for each in histories)
    assert any(each.flipped.any() for each in histories)


def test_the_score_follows_from_the_features(photo) -> None:
    _, histories, _ = photo
    for history in histories:
        assert set(history.features) == set(WEIGHTS)
        values = {name: np.array([value]) for name, value in history.features.items()}
        assert history.score == pytest.approx(score(values)[0])


def test_a_tiny_image_has_no_history() -> None:
    segments, histories = detect_with_history(np.zeros((2, 9), np.uint8))
    assert (len(segments), histories) == (0, ())
