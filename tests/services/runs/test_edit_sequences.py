"""Any sequence of edits, undos and redos leaves what a simple model predicts."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any
from uuid import uuid4

import numpy as np
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from sqlalchemy import select

from app.db.models import Blob, Camera, Image, Review
from app.services.edits import store_edit
from app.services.stored_edits import EditGiven, StoredEdit


def line(start: float, stop: float) -> np.ndarray:
    x = np.arange(start, stop + 1, dtype=np.float32)
    return np.stack([x, np.full_like(x, 20)], axis=1)


@dataclass
class Model:
    """What should be current: a stack machine of sets."""

    current: dict[int, str]
    done: list[StoredEdit] = field(default_factory=list)
    undone: list[StoredEdit] = field(default_factory=list)
    put_away: dict[int, str] = field(default_factory=dict)

    def move(self, going: tuple[int, ...], coming: tuple[int, ...], verdict: str | None) -> None:
        self.put_away |= {key: self.current.pop(key) for key in going}
        self.current |= {key: verdict or self.put_away[key] for key in coming}


STEPS = st.one_of(
    st.tuples(st.sampled_from(["trace", "undo", "redo"]), st.just(0), st.just(0)),
    st.tuples(st.sampled_from(["cut", "trim", "extend", "join"]), st.integers(0, 9), st.integers(0, 9)),
    st.tuples(st.sampled_from(["keep", "reject", "late"]), st.integers(0, 9), st.just(0)),
)


@settings(max_examples=5, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(steps=st.lists(STEPS, min_size=4, max_size=10))
def test_what_is_current_is_what_the_model_predicts(bench, steps) -> None:
    image = _new_image(bench)
    place = type(bench)(bench.database, bench.dataset_id, (image,), bench.now)
    model = Model({})
    for _ in range(2):
        _step(place, model, "trace", 0, 0)
    for step in steps:
        _step(place, model, *step)
        entries = place.segments(image)
        assert {entry.id: entry.verdict for entry in entries} == model.current
        with place.database.read() as session:
            row = session.get_one(Image, image)
            assert (row.n_candidates, row.n_keep) == (len(entries), sum(e.verdict == "keep" for e in entries))


def _step(place: Any, model: Model, what: str, first: int, second: int) -> None:
    image, ids = place.images[0], sorted(model.current)
    if what in ("undo", "redo"):
        stack, other = (model.done, model.undone) if what == "undo" else (model.undone, model.done)
        if not stack:
            return
        stored = stack[-1]
        verdict = "undecided" if what == "undo" else "keep"
        going, coming = (stored.added, stored.replaced) if what == "undo" else (stored.replaced, stored.added)
        place.decide(image, dict.fromkeys(stored.added, verdict), kind=what, target_group_id=stored.client_id)
        other.append(stack.pop())
        model.move(going, coming, None if what == "undo" else "keep")
    elif what == "late":
        away = sorted(set(model.put_away) - set(ids))
        if away:
            place.decide(image, {away[first % len(away)]: "keep"})
            model.put_away[away[first % len(away)]] = "keep"
    elif what in ("keep", "reject"):
        if ids:
            place.decide(image, {ids[first % len(ids)]: what})
            model.current[ids[first % len(ids)]] = what
    else:
        _edit(place, model, what, ids, first, second)


def _edit(place: Any, model: Model, kind: str, ids: list[int], first: int, second: int) -> None:
    needed = {"trace": 0, "join": 2}.get(kind, 1)
    if len(ids) < needed:
        return
    start = first % max(len(ids), 1)
    replaces = tuple(ids[(start + step * (1 + second % max(len(ids) - 1, 1))) % len(ids)] for step in range(needed))
    verdicts = {model.current[key] for key in replaces}
    adds = (line(10, 60), line(61, 130)) if kind == "cut" else (line(10, 130),)
    with place.database.write() as session:
        wanted = EditGiven(str(uuid4()), kind, replaces, adds)
        stored = store_edit(session, place.images[0], wanted, "owner", place.now)
    model.done.append(stored)
    model.undone.clear()
    model.move(replaces, stored.added, verdicts.pop() if kind == "cut" else "keep")


def _new_image(bench: Any) -> int:
    name = uuid4().hex
    with bench.database.write() as session:
        session.add(Blob(sha256=2 * name, size=1, media_type="image/png", created_at=bench.now))
        session.flush()
        image = Image(
            dataset_id=bench.dataset_id,
            name=name,
            file_name=f"{name}.png",
            sha256=2 * name,
            width=200,
            height=160,
            bits=8,
            camera=session.scalars(select(Camera)).first(),
            created_at=bench.now,
            review=Review(status="open", updated_at=bench.now),
        )
        session.add(image)
        session.flush()
        return image.id
