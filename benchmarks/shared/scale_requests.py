"""What pages ask of the API, as addresses: of images and places that change from one request to the next."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from urllib.parse import quote, urlencode

import numpy as np
from shared.scale_world import DONE, OPEN, PEOPLE, SOURCES, World

from app.services.paging import Value, write_cursor

SLUG = "dataset-00"
"""The largest dataset; what is asked most is asked of it."""
PAGE = 200
"""Images of a page, as the browser tool asks for them."""


@dataclass(frozen=True)
class PageQuery:
    """One kind of request.

    Attributes:
        name: As tables show it.
        path: Gives the address, from a number that changes with each request.
        role: Who asks.
        counts: Whether it is an aggregate over the whole dataset by its nature, or over all its decisions.
    """

    name: str
    path: Callable[[int], str]
    role: str = "admin"
    counts: bool = False


def page_queries(world: World) -> list[PageQuery]:
    """Return what the pages of an installation ask."""
    return [*_of_lists(world), *_of_images(world), *_of_datasets(world), *_of_boards(world)]


def deep_cursors(world: World, number: int) -> dict[str, str]:
    """Return a cursor deep in the largest dataset for each order of its images."""
    size = int(world.first[1])
    place = size // 3 + number * 37 % (size // 2)
    order = np.argsort(np.array(world.names[:size]))
    row = int(order[place])
    by_candidates = int(np.argsort(world.candidates[:size], kind="stable")[place])
    added = datetime.fromtimestamp(world.added[row], UTC)
    values: dict[str, tuple[Value | datetime, int]] = {
        "name": (world.names[row], row + 1),
        "created": (added, row + 1),
        "candidates": (int(world.candidates[by_candidates]), by_candidates + 1),
    }
    return {
        sign + name: write_cursor(sign + name, value, row_id)
        for name, (value, row_id) in values.items()
        for sign in ("", "-")
    }


def _of_lists(world: World) -> list[PageQuery]:
    size = int(world.first[1])
    cursors = [deep_cursors(world, number) for number in range(8)]
    hidden_sequences = sorted(set(world.sequence[:size].tolist()))

    def images(number: int, **chosen: object) -> str:
        del number
        return f"/datasets/{SLUG}/images?{urlencode({'limit': PAGE, **chosen})}"

    filters: Sequence[tuple[str, Callable[[int], dict[str, object]]]] = (
        *(
            (f"status {status}", lambda _, status=status: {"status": status})
            for status in ("open", "done", "discarded")
        ),
        ("source", lambda number: {"source": SOURCES[number % len(SOURCES)]}),
        ("camera", lambda number: {"camera": int(world.camera[number * 211 % size]) + 1}),
        ("sequence", lambda number: {"sequence": f"drive_{hidden_sequences[number * 7 % len(hidden_sequences)]:04d}"}),
        ("prelabel done", lambda _: {"prelabel": "done"}),
        ("prelabel failed", lambda _: {"prelabel": "failed"}),
        ("prelabel none", lambda _: {"prelabel": "none"}),
        ("search, few", lambda number: {"search": f"{number * 97 % size:07d}"}),
        ("search, many", lambda _: {"search": "kitti"}),
        ("assignee", lambda number: {"assignee": PEOPLE[number % len(PEOPLE)]}),
        ("nobody's task", lambda _: {"assignee": ""}),
        ("person", lambda number: {"person": PEOPLE[number % len(PEOPLE)]}),
        ("person unknown", lambda _: {"person": "Nobody"}),
        ("verdict keep", lambda _: {"verdict": "keep"}),
        ("verdict undecided", lambda _: {"verdict": "undecided"}),
        ("score from 0.9", lambda _: {"min_score": 0.9}),
        ("score from 0.9995", lambda _: {"min_score": 0.9995}),
        ("score up to 0.01", lambda _: {"max_score": 0.01}),
        ("score 0.4 to 0.45", lambda _: {"min_score": 0.4, "max_score": 0.45}),
        ("status and source", lambda number: {"status": "done", "source": SOURCES[number % len(SOURCES)]}),
        ("deleted", lambda _: {"deleted": "true"}),
    )
    return [
        PageQuery("images, first page", images),
        *(
            PageQuery(f"images by {sort}, first", lambda number, sort=sort: images(number, sort=sort))
            for sort in ("-name", "created", "-created", "candidates", "-candidates")
        ),
        *(
            PageQuery(
                f"images by {sort}, deep",
                lambda number, sort=sort: images(number, sort=sort, cursor=cursors[number % 8][sort]),
            )
            for sort in cursors[0]
        ),
        *(
            PageQuery(f"images, {name}", lambda number, chosen=chosen: images(number, **chosen(number)))
            for name, chosen in filters
        ),
    ]


def _of_images(world: World) -> list[PageQuery]:
    size = int(world.first[1])
    done = np.flatnonzero(world.status[:size] == DONE)
    waiting = np.flatnonzero(world.status[:size] == OPEN)

    def one(number: int, what: str, rows: np.ndarray = done) -> str:
        return f"/images/{int(rows[number * 101 % len(rows)]) + 1}{what}"

    return [
        PageQuery("image, reviewed", lambda number: one(number, "")),
        PageQuery("image, next to review", lambda number: one(number, "", waiting)),
        PageQuery("image, for a reader", lambda number: one(number, ""), role="reader"),
        PageQuery("its segments", lambda number: one(number, "/segments")),
        PageQuery("its points", lambda number: one(number, "/points")),
        PageQuery("its decisions", lambda number: one(number, "/decisions")),
        PageQuery("its edits", lambda number: one(number, "/edits")),
    ]


def _of_datasets(world: World) -> list[PageQuery]:
    datasets = len(world.first) - 1
    cameras = np.flatnonzero(world.camera_dataset == 0)

    def camera(number: int) -> int:
        return int(cameras[number % len(cameras)]) + 1

    of = f"/datasets/{SLUG}"
    run = datasets + 1
    return [
        PageQuery("datasets", lambda _: "/datasets"),
        PageQuery("datasets, for a reader", lambda _: "/datasets", role="reader"),
        PageQuery("dataset", lambda _: of),
        PageQuery("dataset, for a reader", lambda _: of, role="reader"),
        PageQuery("facets", lambda _: f"{of}/facets"),
        PageQuery("people", lambda _: f"{of}/people", counts=True),
        PageQuery("statistics", lambda _: f"{of}/statistics", counts=True),
        PageQuery("agreement", lambda _: f"{of}/agreement", counts=True),
        PageQuery("differences", lambda _: f"{of}/differences", counts=True),
        PageQuery("second reviews", lambda _: f"{of}/second-reviews", counts=True),
        PageQuery("card", lambda _: f"{of}/card", counts=True),
        PageQuery("runs", lambda _: f"{of}/runs"),
        PageQuery("run", lambda _: f"/runs/{run}"),
        PageQuery("run's images", lambda _: f"/runs/{run}/images?limit=100"),
        PageQuery("run's failed images", lambda _: f"/runs/{run}/images?limit=100&status=failed"),
        PageQuery("cameras", lambda _: f"{of}/cameras"),
        PageQuery("camera", lambda number: f"/cameras/{camera(number)}"),
        PageQuery("its calibrations", lambda number: f"/cameras/{camera(number)}/calibrations"),
        PageQuery("audit", lambda _: "/audit?limit=100"),
        PageQuery("audit of a person", lambda _: f"/audit?limit=100&person={quote(PEOPLE[1])}"),
        PageQuery("status of the server", lambda _: "/status"),
    ]


def _of_boards(world: World) -> list[PageQuery]:
    del world
    return [
        PageQuery("splits", lambda _: "/splits"),
        PageQuery("splits, for a reader", lambda _: "/splits", role="reader"),
        PageQuery("split", lambda _: "/splits/open-split", role="reader"),
        PageQuery("split, for a maintainer", lambda _: "/splits/open-split"),
        PageQuery("its images", lambda _: "/splits/open-split/images?limit=100", role="reader"),
        PageQuery("board", lambda _: "/splits/open-split/board", role="reader"),
        PageQuery("submissions", lambda _: "/splits/open-split/submissions?limit=50", role="reader"),
        PageQuery("submission", lambda number: f"/submissions/{1 + number % 20 * 2}", role="reader"),
        PageQuery("submission's images", lambda number: f"/submissions/{1 + number % 20 * 2}/images", role="reader"),
        PageQuery("method", lambda number: f"/methods/method-{number % 20 * 2:02d}", role="reader"),
    ]
