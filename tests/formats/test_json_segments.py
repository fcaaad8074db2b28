import json

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.errors import ClearLinesError, InvalidFile, TooLarge
from app.formats.json_segments import read_json, read_json_set
from app.formats.limits import SegmentLimits, SetLimits


def document(*segments):
    return json.dumps({"segments": list(segments)}).encode()


def test_a_file_as_a_person_writes_it():
    text = b"""\xef\xbb\xbf{ "width": 640, "segments": [
        {"points": [[1, 2], [3.5, -4e0]], "score": 1, "straightness": 0.25,
         "verdict": "keep", "origin": "import", "id": "7"},
        {"points": [[5, 6]], "score": 0, "straightness": 0, "verdict": null}
    ]}"""
    found = read_json(text)
    assert found.segments.scores is not None
    assert found.straightness is not None
    assert [line.tolist() for line in found.segments] == [[[1, 2], [3.5, -4]], [[5, 6]]]
    assert found.segments.scores.tolist() == [1, 0]
    assert found.straightness.tolist() == [0.25, 0]
    assert (found.verdicts, found.origins, found.ids) == (("keep", None), ("import", None), ("7", None))


def test_a_rejection_may_have_a_reason():
    found = read_json(document({"points": [[1, 2]], "verdict": "reject", "reason": "shadow"}, {"points": [[3, 4]]}))
    assert (found.verdicts, found.reasons) == (("reject", None), ("shadow", None))


def test_only_points_are_needed():
    found = read_json(document({"points": [[1, 2]]}))
    assert found.segments.scores is found.straightness is found.verdicts is found.origins is found.ids is None
    assert found.reasons is None


@pytest.mark.parametrize(
    ("data", "message", "where"),
    [
        (b"", "no JSON", "a.json: line 1, column 1"),
        (b'{"segments": [', "no JSON", "a.json: line 1, column 15"),
        (b"\xff{}", "not UTF-8", "a.json: byte 0"),
        (b"[" * 100_000, "nested", "a.json"),
        (b'{"segments": ' + b"9" * 5000 + b"}", "too long", "a.json"),
        (b"[]", "no list of segments", "a.json"),
        (b"{}", "no list of segments", "a.json"),
        (b'{"segments": {}}', "no list of segments", "a.json"),
        (b'{"segments": [], "segments": []}', "stands twice", "a.json"),
        (b'{"segments": [{"points": [[NaN, 1]]}]}', "NaN", "a.json"),
        (b'{"segments": [{"points": [[1, -Infinity]]}]}', "Infinity", "a.json"),
        (b'{"segments": [{"points": [[1, 1e999]]}]}', "not finite", "a.json: segment 0, point 0"),
        (document({"points": [[1, 2]]}, 5), "no points", "a.json: segment 1"),
        (document({"point": [[1, 2]]}), "no points", "a.json: segment 0"),
        (document({"points": [[1, 2]], "scroe": 1}), "unknown field 'scroe'", "a.json: segment 0"),
        (document({"points": {}}), "no list", "a.json: segment 0"),
        (document({"points": []}), "no points", "a.json: segment 0"),
        (document({"points": [[1, 2], [3]]}), "no point", "a.json: segment 0, point 1"),
        (document({"points": [[1, 2, 3]]}), "no point", "a.json: segment 0, point 0"),
        (document({"points": [1, 2]}), "no point", "a.json: segment 0, point 0"),
        (document({"points": ["ab"]}), "no point", "a.json: segment 0, point 0"),
        (document({"points": [[1, "2"]]}), "no point", "a.json: segment 0, point 0"),
        (document({"points": [[1, True]]}), "no point", "a.json: segment 0, point 0"),
        (document({"points": [[1, None]]}), "no point", "a.json: segment 0, point 0"),
        (document({"points": [[1, 10**400]]}), "too large", "a.json: segment 0"),
        (document({"points": [[0, 0]]}, {"points": [[1, 2], [3, 1e9]]}), "outside", "a.json: segment 1, point 1"),
        (document({"points": [[1, 2]], "score": 2}), "no score", "a.json: segment 0, score"),
        (document({"points": [[1, 2]], "score": "1"}), "no score", "a.json: segment 0, score"),
        (document({"points": [[1, 2]], "score": True}), "no score", "a.json: segment 0, score"),
        (
            document({"points": [[1, 2]], "score": 1}, {"points": [[1, 2]]}),
            "no score, although",
            "a.json: segment 1, score",
        ),
        (document({"points": [[1, 2]], "straightness": -1}), "no straightness", "a.json: segment 0, straightness"),
        (document({"points": [[1, 2]], "verdict": "Keep"}), "no verdict", "a.json: segment 0, verdict"),
        (
            document({"points": [[1, 2]], "verdict": "reject", "reason": "rain"}),
            "no reason",
            "a.json: segment 0, reason",
        ),
        (
            document({"points": [[1, 2]]}, {"points": [[1, 2]], "verdict": "keep", "reason": "car"}),
            "for nothing",
            "a.json: segment 1, reasons",
        ),
        (document({"points": [[1, 2]], "reason": "car"}), "for nothing", "a.json: segment 0, reasons"),
        (document({"points": [[1, 2]], "origin": 3}), "no origin", "a.json: segment 0, origin"),
        (document({"points": [[1, 2]], "id": 3}), "no id", "a.json: segment 0, id"),
        (document({"points": [[1, 2]], "id": "a\u0000"}), "no id", "a.json: segment 0, id"),
        (document({"points": [[1, 2]], "id": "\ud800"}), "no id", "a.json: segment 0, id"),
    ],
)
def test_every_mistake_is_named_with_its_place(data, message, where):
    with pytest.raises(InvalidFile) as caught:
        read_json(data, where="a.json")
    assert message in caught.value.message
    assert caught.value.where == where


@pytest.mark.parametrize("limits", [SegmentLimits(segments=1), SegmentLimits(points=2), SegmentLimits(json_bytes=20)])
def test_limits(limits):
    with pytest.raises(TooLarge):
        read_json(document({"points": [[1, 2], [3, 4]]}, {"points": [[1, 2]]}), limits=limits)


def test_empty_lists_take_no_memory_by_the_million():
    with pytest.raises(TooLarge) as caught:
        read_json(b'{"segments": [' + b"[]," * 2000 + b"[]]}", limits=SegmentLimits(segments=100, points=1000))
    assert "lists and objects" in caught.value.message


def test_one_file_for_all_images():
    images = {"KITTI/0": {"segments": [{"points": [[1, 2]], "score": 0.5}]}, "b": {"segments": []}}
    found = read_json_set(json.dumps({"images": images}).encode())
    assert list(found) == ["KITTI/0", "b"]
    assert found["KITTI/0"].segments.scores == np.float32(0.5)
    assert len(found["b"]) == 0


@pytest.mark.parametrize(
    ("images", "message", "where"),
    [
        (None, "no images", "a.json"),
        ([], "no images", "a.json"),
        ({"../x": {"segments": []}}, "no name", "a.json"),
        ({"": {"segments": []}}, "no name", "a.json"),
        ({"x": {}}, "no list", "a.json: image x"),
        ({"x": {"segments": [{"points": [[1, None]]}]}}, "no point", "a.json: image x: segment 0, point 0"),
    ],
)
def test_mistakes_in_sets(images, message, where):
    with pytest.raises(InvalidFile) as caught:
        read_json_set(json.dumps({"images": images}).encode(), where="a.json")
    assert message in caught.value.message
    assert caught.value.where == where


@pytest.mark.parametrize(
    "limits",
    [SetLimits(images=1), SetLimits(segments=1), SetLimits(points=1), SetLimits(image=SegmentLimits(points=0))],
)
def test_limits_of_sets(limits):
    images = {name: {"segments": [{"points": [[1, 2]]}]} for name in "ab"}
    with pytest.raises(TooLarge):
        read_json_set(json.dumps({"images": images}).encode(), limits=limits)


json_values = st.recursive(
    st.none() | st.booleans() | st.floats() | st.integers() | st.text(max_size=3),
    lambda inner: (
        st.lists(inner, max_size=3)
        | st.dictionaries(st.sampled_from(["segments", "images", "points", "score", "id"]), inner, max_size=3)
    ),
    max_leaves=12,
)


@settings(max_examples=100, deadline=None)
@given(st.one_of(json_values, st.builds(lambda value: {"segments": [{"points": value}]}, json_values)))
def test_any_json_is_read_or_refused_and_nothing_else(value):
    for read in (lambda data: {"": read_json(data)}, read_json_set):
        try:
            found = read(json.dumps(value).encode())
        except ClearLinesError:
            continue
        for item in found.values():
            assert np.isfinite(item.segments.points).all()
