"""How far people agree, where they differ, what is decided there, and the statistics of a dataset."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, TypeVar

from fastapi import APIRouter, Query
from sqlalchemy.orm import Session

from app.api.deps import Cursor, Limit, Now, Server, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.agreement import AdjudicationGiven, AgreementAnswer, Difference, DifferencePage
from app.api.schemas.base import RowId
from app.api.schemas.statistics import StatisticsAnswer
from app.db.models import Dataset
from app.services.adjudicating import adjudicate, take_back
from app.services.agreements import agreement_of
from app.services.datasets import get_dataset
from app.services.differences import count_differences, list_differences
from app.services.remembering import is_large
from app.services.statistics import statistics_of

Value = TypeVar("Value")

router = APIRouter(tags=["agreement"], responses=answers(404))


@router.get("/datasets/{slug}/agreement")
def read_agreement(server: ServerDep, now: Now, slug: str) -> AgreementAnswer:
    """Return Cohen's kappa of first and second reviews: over all, per image, pair of people, person and length.

    Of a dataset of more than 2,000 images it is counted once a minute at most.
    """
    return AgreementAnswer.model_validate(_counted(server, now, slug, agreement_of))


@router.get("/datasets/{slug}/differences")
def read_differences(
    server: ServerDep,
    now: Now,
    slug: str,
    adjudicated: Annotated[bool | None, Query(description="Decided on since, or not yet; both when left out.")] = None,
    limit: Limit = 100,
    cursor: Cursor = None,
) -> DifferencePage:
    """List the candidates on which second reviews that are done differ from the first, by image.

    Of a dataset of more than 2,000 images, ``total`` is counted once a minute at most.
    """

    def count(session: Session, dataset: Dataset) -> int:
        return count_differences(session, dataset, adjudicated=adjudicated)

    total = _counted(server, now, slug, count, adjudicated)
    with server.database.read() as session:
        dataset = get_dataset(session, slug)
        page = list_differences(session, dataset, adjudicated=adjudicated, limit=limit, cursor=cursor, total=total)
        return DifferencePage.model_validate(page)


@router.post("/second-reviews/{second_review_id}/adjudications", responses=answers(409))
def add_adjudication(
    server: ServerDep, viewer: ViewerDep, now: Now, second_review_id: RowId, given: AdjudicationGiven
) -> Difference:
    """Decide between two verdicts, by a normal decision. Sending it again changes nothing."""
    with server.database.write() as session:
        decided = adjudicate(
            session, second_review_id, given.segment_id, given.verdict, given.client_id, viewer.name, now
        )
        return Difference.model_validate(decided)


@router.delete("/second-reviews/{second_review_id}/adjudications/{segment_id}", responses=answers(409))
def delete_adjudication(
    server: ServerDep, viewer: ViewerDep, now: Now, second_review_id: RowId, segment_id: RowId
) -> Difference:
    """Take an adjudication back: the candidate has the verdict again that it had before."""
    with server.database.write() as session:
        return Difference.model_validate(take_back(session, second_review_id, segment_id, viewer.name, now))


@router.get("/datasets/{slug}/statistics")
def read_statistics(server: ServerDep, now: Now, slug: str) -> StatisticsAnswer:
    """Return progress, pace, time per decision, use of suggestions, reasons and agreement.

    Of a dataset of more than 2,000 images, they are counted once a minute at most.
    """

    def count(session: Session, dataset: Dataset) -> StatisticsAnswer:
        log = server.work_logs.of(dataset.id, now)
        return StatisticsAnswer.model_validate(statistics_of(session, dataset, log))

    return _counted(server, now, slug, count)


def _counted(server: Server, now: Now, slug: str, count: Callable[[Session, Dataset], Value], *of: object) -> Value:
    """Return what is counted over all of a dataset, remembered where it is large; ``of`` tells counts apart."""

    def make() -> Value:
        with server.database.read() as session:
            return count(session, get_dataset(session, slug))

    with server.database.read() as session:
        dataset = get_dataset(session, slug)
        large = is_large(session, dataset)
    return server.remembered.get((count.__qualname__, dataset.id, of), now, make) if large else make()
