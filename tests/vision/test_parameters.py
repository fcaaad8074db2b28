import json
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.errors import InvalidInput
from app.vision.parameters import DetectionParameters


def test_the_defaults_find_weaker_edges_than_the_papers_thresholds() -> None:
    parameters = DetectionParameters()
    assert (parameters.low_threshold, parameters.high_threshold) == (30.0, 60.0)
    assert parameters.min_length == 100.0
    assert parameters.clahe_clip == 2.0
    assert parameters.operating_point == "balanced"


@given(
    min_length=st.floats(10, 1000),
    low=st.floats(1, 50),
    high=st.floats(50, 1000),
    point=st.sampled_from(["recall", "balanced", "precise"]),
)
def test_a_round_trip_through_json_keeps_everything(min_length: float, low: float, high: float, point: str) -> None:
    fields = {"min_length": min_length, "low_threshold": low, "high_threshold": high, "operating_point": point}
    parameters = DetectionParameters.from_dict(fields)
    again = DetectionParameters.from_dict(json.loads(json.dumps(parameters.as_dict())))
    assert again == parameters
    assert again.min_length == min_length


@pytest.mark.parametrize(
    ("fields", "where"),
    [
        ({"min_length": 0}, "min_length"),
        ({"min_length": math.nan}, "min_length"),
        ({"min_length": "long"}, "min_length"),
        ({"min_length": True}, "min_length"),
        ({"sigma": math.inf}, "sigma"),
        ({"clahe_tile": 2}, "clahe_tile"),
        ({"low_threshold": 90}, "low_threshold"),
        ({"operating_point": "best"}, "operating_point"),
        ({"length": 100}, "parameters"),
    ],
)
def test_a_bad_value_is_refused_by_name(fields: dict[str, object], where: str) -> None:
    with pytest.raises(InvalidInput) as caught:
        DetectionParameters.from_dict(fields)
    assert caught.value.where == where
    assert caught.value.expected


def test_a_list_is_no_set_of_parameters() -> None:
    with pytest.raises(InvalidInput):
        DetectionParameters.from_dict([1, 2])  # type: ignore[arg-type]


def test_whole_numbers_are_taken_as_lengths() -> None:
    assert DetectionParameters(min_length=60).as_dict()["min_length"] == 60.0


def test_parameters_that_were_stored_before_are_read_as_they_were() -> None:
    stored = {
        "min_length": 100.0,
        "low_threshold": 40.0,
        "high_threshold": 80.0,
        "clahe_clip": 2.0,
        "clahe_tile": 96.0,
        "sigma": 0.5,
        "operating_point": "balanced",
    }
    assert DetectionParameters.from_dict(stored).as_dict() == stored
