"""The error tree."""

from __future__ import annotations

import pickle
import re

import pytest

from app import errors
from app.errors import ClearLinesError, InvalidImage, InvalidInput


def kinds() -> list[type[ClearLinesError]]:
    found = [ClearLinesError]
    for kind in found:
        found += kind.__subclasses__()
    return [kind for kind in found if kind.__module__ == errors.__name__]


@pytest.mark.parametrize("kind", kinds())
def test_an_error_crosses_a_process_border_whole(kind: type[ClearLinesError]) -> None:
    error = kind("it broke", where="here", expected="whole", hint="mend it", details={"n": 1})
    other = pickle.loads(pickle.dumps(error))
    assert type(other) is kind
    assert other.as_dict() == error.as_dict()


def test_an_error_says_what_where_expected_and_hint() -> None:
    error = InvalidInput("too short", where="line 3", expected="5 px", hint="draw it longer")
    assert str(error) == "line 3: too short; expected: 5 px; hint: draw it longer"
    assert str(InvalidInput("too short")) == "too short"
    assert InvalidImage("x").as_dict() == {"code": "invalid-image", "message": "x"}


def test_the_list_at_the_top_of_the_file_is_the_tree_with_its_statuses() -> None:
    listed = dict(re.findall(r"^ +(\w+) {2,}\S.*?(\d{3})$", errors.__doc__ or "", re.MULTILINE))
    tree = {kind.__name__: str(kind.status) for kind in kinds() if kind is not ClearLinesError}
    assert listed == tree
