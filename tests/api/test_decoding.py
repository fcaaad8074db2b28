"""Images are decoded a few at a time, and nobody who waits for that holds a session of the database."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient

from app.api.decoding import Decoding
from app.errors import Unavailable


def test_who_finds_no_place_in_time_is_told() -> None:
    decoding = Decoding(places=2, patience=0)
    with decoding.place(), decoding.place(), pytest.raises(Unavailable, match="decoded"), decoding.place():
        raise AssertionError
    with decoding.place():  # the others are free again
        pass


def test_a_place_is_free_again_after_an_error() -> None:
    decoding = Decoding(places=1, patience=0)
    with pytest.raises(ZeroDivisionError), decoding.place():
        _ = 1 / 0
    with decoding.place():
        pass


@pytest.fixture
def in_use(client: TestClient) -> list[int]:
    """How many sessions of the database were held whenever somebody took a place."""
    state = client.app.state  # type: ignore[attr-defined]
    pool = state.server.database.engine.pool
    held: list[int] = []

    class Watched(Decoding):
        @contextmanager
        def place(self) -> Iterator[None]:
            deadline = time.monotonic() + 10
            while pool.checkedout() and time.monotonic() < deadline:  # the dispatcher asks now and then
                pass
            held.append(pool.checkedout())
            yield

    state.server = dataclasses.replace(state.server, decoding=Watched())
    return held


@pytest.mark.parametrize(
    "address",
    [
        "images/{image}/display?view=clahe",
        "images/{image}/thumbnail",
        "images/{image}/neighbour_verdicts",
        "segments/{segment}/evidence",
    ],
)
def test_whoever_decodes_holds_no_session(
    client: TestClient, prelabelled: list[int], in_use: list[int], address: str
) -> None:
    segment = client.get(f"/api/images/{prelabelled[0]}/segments").json()["segments"][0]["id"]
    answer = client.get(f"/api/{address.format(image=prelabelled[0], segment=segment)}")
    assert (answer.status_code, in_use) == (200, [0])


@pytest.mark.parametrize(("kind", "places"), [(np.uint8, []), (np.uint16, [0])])
def test_a_place_is_taken_only_for_what_must_be_decoded(
    client: TestClient, upload: Any, in_use: list[int], kind: type, places: list[int]
) -> None:
    content = cv2.imencode(".png", np.full((60, 80), 90, kind))[1].tobytes()
    image = upload("walls", {"wall.png": content})["added"][0]["id"]
    in_use.clear()
    answer = client.get(f"/api/images/{image}/display")
    assert (answer.status_code, answer.headers["content-type"], in_use) == (200, "image/png", places)
