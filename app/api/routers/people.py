"""Several people: who has an image open, whose task it is, what they are asked."""

from __future__ import annotations

from uuid import UUID

from fastapi import APIRouter, Response, status

from app.api.deps import Now, Reader, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.base import RowId
from app.api.schemas.people import (
    Assigned,
    AssignGiven,
    GuidelinesAnswer,
    LeaseAnswer,
    LeaseGiven,
    PersonAnswer,
)
from app.services.assigning import assign
from app.services.dataset_rules import guidelines_of
from app.services.datasets import get_dataset
from app.services.leases import release_lease, renew_lease
from app.services.people import people_of

router = APIRouter(tags=["people"], responses=answers(404))


@router.put("/images/{image_id}/lease")
def put_lease(server: ServerDep, viewer: ViewerDep, now: Now, image_id: RowId, given: LeaseGiven) -> LeaseAnswer:
    """Say that you have an image open, for 60 s. The first one holds it; others see who it is and can take it over."""
    with server.database.write() as session:
        state = renew_lease(session, image_id, str(given.client_id), viewer.name, now, take_over=given.take_over)
        return LeaseAnswer.model_validate(state)


@router.delete("/images/{image_id}/lease", status_code=status.HTTP_204_NO_CONTENT)
def delete_lease(server: ServerDep, viewer: ViewerDep, image_id: RowId, client_id: UUID) -> Response:
    """Say that you have left an image."""
    with server.database.write() as session:
        release_lease(session, image_id, str(client_id), viewer.name)
    return Response(status_code=status.HTTP_204_NO_CONTENT)


@router.get("/datasets/{slug}/people")
def list_people(server: ServerDep, now: Now, slug: str) -> list[PersonAnswer]:
    """List everyone who has images of a dataset to review, or decided on some."""
    with server.database.read() as session:
        dataset = get_dataset(session, slug)
    decided = server.work_logs.of(dataset.id, now).decisions_by_person()
    with server.database.read() as session:
        return [PersonAnswer.model_validate(person) for person in people_of(session, dataset, decided)]


@router.post("/datasets/{slug}/assign")
def assign_images(server: ServerDep, viewer: ViewerDep, now: Now, slug: str, given: AssignGiven) -> Assigned:
    """Make images someone's task, by hand or in equal shares. Images of one sequence stay with one person."""
    with server.database.write() as session:
        dataset = get_dataset(session, slug)
        shares = assign(session, dataset, given.people, given.mode, given.image_ids, now, person=viewer.name)
    return Assigned.model_validate({"people": shares})


@router.get("/datasets/{slug}/guidelines")
def read_guidelines(session: Reader, slug: str) -> GuidelinesAnswer:
    """Return what a dataset's annotators read, and what they are asked."""
    return GuidelinesAnswer.model_validate(guidelines_of(get_dataset(session, slug)))
