"""Datasets: list, make, rename, delete and restore."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, status

from app.api.deps import Now, Reader, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.datasets import DatasetAnswer, DatasetChange, DatasetGiven, Deleted
from app.services import dataset_overviews, dataset_rules, datasets

router = APIRouter(prefix="/datasets", tags=["datasets"])


@router.get("")
def list_datasets(server: ServerDep, viewer: ViewerDep, session: Reader, deleted: bool = False) -> list[DatasetAnswer]:
    """List the datasets by name; with ``deleted`` those that can still be restored."""
    found = dataset_overviews.list_datasets(session, grace=server.settings.grace, deleted=deleted, viewer=viewer)
    return [DatasetAnswer.model_validate(dataset) for dataset in found]


@router.post("", status_code=status.HTTP_201_CREATED, responses=answers(409))
def create_dataset(server: ServerDep, viewer: ViewerDep, now: Now, given: DatasetGiven) -> DatasetAnswer:
    """Make an empty dataset."""
    with server.database.write() as session:
        dataset = datasets.create_dataset(session, given.name, now, person=viewer.name)
        return _answer(server, session, dataset.slug)


@router.get("/{slug}", responses=answers(404))
def read_dataset(server: ServerDep, session: Reader, slug: str) -> DatasetAnswer:
    """Return one dataset with how far it is."""
    return _answer(server, session, slug)


@router.patch("/{slug}", responses=answers(404, 409))
def change_dataset(server: ServerDep, viewer: ViewerDep, now: Now, slug: str, given: DatasetChange) -> DatasetAnswer:
    """Give a dataset another name, which leaves its address as it is, or change what its card says."""
    texts = {name: getattr(given, name) for name in given.model_fields_set & set(datasets.CARD_TEXTS)}
    with server.database.write() as session:
        dataset = datasets.describe_dataset(session, slug, texts, now, person=viewer.name)
        dataset_rules.change_rules(session, slug, now, person=viewer.name, **_rules(given))
        if given.name is not None:
            datasets.rename_dataset(session, slug, given.name, now, person=viewer.name)
        return _answer(server, session, dataset.slug)


@router.delete("/{slug}", responses=answers(404))
def delete_dataset(server: ServerDep, viewer: ViewerDep, now: Now, slug: str) -> Deleted:
    """Delete a dataset with all that is in it; it can be restored during the grace period."""
    with server.database.write() as session:
        deleted = datasets.delete_dataset(session, slug, now, grace=server.settings.grace, person=viewer.name)
        return Deleted.model_validate(deleted)


@router.post("/{slug}/restore", responses=answers(404, 409))
def restore_dataset(server: ServerDep, viewer: ViewerDep, now: Now, slug: str) -> DatasetAnswer:
    """Bring a deleted dataset back."""
    with server.database.write() as session:
        dataset = datasets.restore_dataset(session, slug, now, person=viewer.name)
        answer = _answer(server, session, dataset.slug)
    server.dispatcher.wake()
    return answer


def _rules(given: DatasetChange) -> dict[str, Any]:
    changes: dict[str, Any] = dict.fromkeys(given.model_fields_set & {"guidelines"}, given.guidelines)
    if "rules" in given.model_fields_set:
        changes["rules"] = dataset_rules.Rules(**({} if given.rules is None else given.rules.model_dump()))
    return changes


def _answer(server: ServerDep, session: Reader, slug: str) -> DatasetAnswer:
    overview = dataset_overviews.dataset_overview(session, slug, grace=server.settings.grace)
    return DatasetAnswer.model_validate(overview)
