"""A second review's verdicts outlive the run whose candidates they are on, as first ones do."""

from __future__ import annotations

from datetime import timedelta
from uuid import uuid4

from app.db.models import Dataset
from app.services.decision_batch import Wish
from app.services.purging import purge
from app.services.reviews import set_review
from app.services.runs import delete_run
from app.services.second_reviews import own_second_review, set_second_review, start_second_review
from app.services.second_verdicts import decide_second, second_history, second_segments
from app.services.verdict_pairs import verdict_pairs
from app.storage import LocalBlobs


def test_a_purged_run_takes_no_second_verdict_along(bench, tmp_path) -> None:
    run = bench.detect(20, 40)
    image = bench.images[0]
    left = bench.at(image, 20)
    bench.decide(image, {bench.at(image, 40): "keep"})
    with bench.database.write() as session:
        set_review(session, image, "done", now=bench.now, allow_undecided=True, person="owner")
        number = start_second_review(session, image, "Jon", bench.now).id
        review, _ = own_second_review(session, number, "Jon", lock=True)
        decide_second(session, review, [Wish(str(uuid4()), str(uuid4()), left, "reject")], "Jon", bench.now)
        delete_run(session, run, bench.now, grace=timedelta())
    assert purge(bench.database, LocalBlobs(tmp_path), bench.now, grace=timedelta()).runs == 1
    with bench.database.read() as session:
        review, _ = own_second_review(session, number, "Jon")
        assert [(row.segment_id, row.verdict) for row in second_history(session, review)] == [(left, "reject")]
    assert [entry.box[1] for entry in bench.segments(image)] == [40]


def test_a_run_during_a_second_review_takes_its_verdicts_along(bench) -> None:
    bench.detect(20, 40)
    image = bench.images[0]
    old = {height: bench.at(image, height) for height in (20, 40)}
    bench.decide(image, {old[20]: "keep", old[40]: "keep"})
    with bench.database.write() as session:
        set_review(session, image, "done", now=bench.now, person="owner")
        number = start_second_review(session, image, "Jon", bench.now).id

    def say(segment: int, verdict: str) -> None:
        with bench.database.write() as session:
            review, _ = own_second_review(session, number, "Jon", lock=True)
            decide_second(session, review, [Wish(str(uuid4()), str(uuid4()), segment, verdict)], "Jon", bench.now)

    def verdicts() -> dict[float, str]:
        with bench.database.read() as session:
            review, _ = own_second_review(session, number, "Jon")
            return {entry.box[1]: entry.verdict for entry in second_segments(session, review).segments}

    say(old[20], "reject")
    bench.detect(20, 40)
    bench.detect(20, 40)
    assert verdicts() == {20: "reject", 40: "undecided"}
    say(old[40], "keep")  # late, from a page that shows the candidates before the runs
    assert verdicts() == {20: "reject", 40: "keep"}
    say(bench.at(image, 20), "ambiguous")
    assert verdicts() == {20: "ambiguous", 40: "keep"}
    with bench.database.write() as session:
        set_second_review(session, number, "done", "Jon", bench.now)
        pairs = verdict_pairs(session, session.get_one(Dataset, bench.dataset_id))
        review, _ = own_second_review(session, number, "Jon")
        assert [row.previous for row in second_history(session, review)] == ["undecided", "undecided", "reject"]
    assert sorted((pair.first, pair.second) for pair in pairs) == [("keep", "ambiguous"), ("keep", "keep")]
