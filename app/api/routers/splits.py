"""Splits: frozen labels that detectors are compared on."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from fastapi import APIRouter, Body, Response, status
from fastapi.responses import FileResponse

from app.api.deps import Cursor, Limit, Now, Reader, ServerDep, ViewerDep
from app.api.freshness import IfNoneMatch
from app.api.pixels import PIXELS, ThumbnailSize, display_answer, original_answer, thumbnail_answer
from app.api.problems import answers
from app.api.schemas.base import RowId
from app.api.schemas.splits import SplitAnswer, SplitChange, SplitGiven, SplitImagePage, VersionGiven
from app.api.schemas.submissions import SubmissionAnswer
from app.errors import NotFound
from app.formats.json_writer import write_json_set
from app.services import split_images, split_overviews, splits
from app.services.access import can_see_details
from app.services.ceilings import add_ceiling
from app.services.submission_access import get_submission
from app.services.submission_views import submission_view
from app.services.truths import read_truth_with_reasons

router = APIRouter(tags=["splits"], responses=answers(404))
TRUTH = {
    200: {
        "content": {
            "application/x-npz": {"schema": {"type": "string", "format": "binary"}},
            "application/json": {"schema": {"type": "object"}},
        }
    }
}


@router.get("/splits")
def list_splits(
    session: Reader, viewer: ViewerDep, now: Now, dataset: str | None = None, deleted: bool = False
) -> list[SplitAnswer]:
    """List the splits, newest first; with ``dataset`` those of one, with ``deleted`` those that can be restored."""
    found = split_overviews.list_splits(session, viewer, now, dataset=dataset, deleted=deleted)
    return [SplitAnswer.model_validate(split) for split in found]


@router.post("/datasets/{slug}/splits", status_code=status.HTTP_201_CREATED, responses=answers(409))
def create_split(server: ServerDep, viewer: ViewerDep, now: Now, slug: str, given: SplitGiven) -> SplitAnswer:
    """Freeze a dataset's labels: kept segments are to be found, ambiguous ones and short ones are ignored.

    409 with a reason for each image whose review isn't done (`details.reasons`).
    """
    with server.database.write() as session:
        plan = splits.SplitPlan(**given.model_dump())
        split = splits.create_split(session, server.blobs, slug, plan, now, person=viewer.name)
        return SplitAnswer.model_validate(split_overviews.split_overview(session, server.blobs, split, viewer, now))


@router.get("/splits/{split}")
def read_split(server: ServerDep, session: Reader, viewer: ViewerDep, now: Now, split: str) -> SplitAnswer:
    """Return one split; maintainers see whether its labels changed since they were frozen."""
    return SplitAnswer.model_validate(
        split_overviews.split_overview(session, server.blobs, splits.get_split(session, split), viewer, now)
    )


@router.patch("/splits/{split}", responses=answers(409))
def change_split(server: ServerDep, viewer: ViewerDep, now: Now, split: str, given: SplitChange) -> SplitAnswer:
    """Change name, description, deadline or daily limit; truth and visibility stay."""
    clears = ("description", "closes_at")  # null stands for no change of what can't be cleared
    named: dict[str, Any] = {name: getattr(given, name) for name in given.model_fields_set}
    changes: dict[str, Any] = {name: value for name, value in named.items() if value is not None or name in clears}
    with server.database.write() as session:
        changed = splits.change_split(session, split, splits.SplitChanges(**changes), now, person=viewer.name)
        return SplitAnswer.model_validate(split_overviews.split_overview(session, server.blobs, changed, viewer, now))


@router.post("/splits/{split}/versions", status_code=status.HTTP_201_CREATED, responses=answers(409))
def freeze_again(
    server: ServerDep,
    viewer: ViewerDep,
    now: Now,
    split: str,
    given: Annotated[VersionGiven, Body(default_factory=VersionGiven)],
) -> SplitAnswer:
    """Freeze the labels as they are now: a new version. Old versions and their scores stay."""
    with server.database.write() as session:
        frozen = splits.freeze_again(session, server.blobs, split, given.image_ids, now, person=viewer.name)
        session.refresh(frozen)
        return SplitAnswer.model_validate(split_overviews.split_overview(session, server.blobs, frozen, viewer, now))


@router.post("/splits/{split}/ceiling", status_code=status.HTTP_202_ACCEPTED, responses=answers(409))
def make_ceiling(server: ServerDep, viewer: ViewerDep, now: Now, split: str) -> SubmissionAnswer:
    """Put what second reviewers kept on the board, as a row without a rank: how well people do against one another.

    409 naming the images of the newest version that nobody has reviewed a second time.
    """
    submission_id = add_ceiling(server.database, server.blobs, split, now, person=viewer.name)
    server.dispatcher.wake()
    with server.database.read() as session:
        submission = get_submission(session, viewer, submission_id)
        return SubmissionAnswer.model_validate(submission_view(session, viewer, submission))


@router.delete("/splits/{split}")
def delete_split(server: ServerDep, viewer: ViewerDep, now: Now, split: str) -> SplitAnswer:
    """Delete a split with its board; it can be restored."""
    with server.database.write() as session:
        deleted = splits.delete_split(session, split, now, person=viewer.name)
        return SplitAnswer.model_validate(split_overviews.split_overview(session, server.blobs, deleted, viewer, now))


@router.post("/splits/{split}/restore", responses=answers(409))
def restore_split(server: ServerDep, viewer: ViewerDep, now: Now, split: str) -> SplitAnswer:
    """Bring a deleted split back."""
    with server.database.write() as session:
        restored = splits.restore_split(session, split, now, person=viewer.name)
        return SplitAnswer.model_validate(split_overviews.split_overview(session, server.blobs, restored, viewer, now))


@router.get("/splits/{split}/images")
def list_split_images(
    session: Reader, split: str, version: RowId | None = None, limit: Limit = 100, cursor: Cursor = None
) -> SplitImagePage:
    """List the images of a split with the addresses of their pixels, page by page, for detectors to run on."""
    found = splits.get_split(session, split)
    chosen = splits.get_version(session, found, version)
    page = split_images.list_split_images(session, found, chosen, limit=limit, cursor=cursor)
    return SplitImagePage.model_validate(page)


@router.get("/splits/{split}/images/{split_image_id}/original", response_class=FileResponse)
def read_split_original(
    server: ServerDep, session: Reader, split: str, split_image_id: RowId, if_none_match: IfNoneMatch = None
) -> Response:
    """Return an image's file as it was uploaded."""
    image = split_images.get_split_image(session, splits.get_split(session, split), split_image_id)
    return original_answer(server, image.image_sha256, image.name, if_none_match)


@router.get("/splits/{split}/images/{split_image_id}/display", response_class=Response, responses={**PIXELS})
def read_split_display(
    server: ServerDep, split: str, split_image_id: RowId, if_none_match: IfNoneMatch = None
) -> Response:
    """Return an image in a form that a browser shows, pixels as stored."""
    with server.database.read() as session:  # given back before the image is decoded
        image = split_images.get_split_image(session, splits.get_split(session, split), split_image_id)
    return display_answer(server, image.image_sha256, if_none_match)


@router.get("/splits/{split}/images/{split_image_id}/thumbnail", response_class=Response, responses={**PIXELS})
def read_split_thumbnail(
    server: ServerDep,
    split: str,
    split_image_id: RowId,
    size: ThumbnailSize = ThumbnailSize.MEDIUM,
    if_none_match: IfNoneMatch = None,
) -> Response:
    """Return a small picture whose longer side is ``size`` px."""
    with server.database.read() as session:  # given back before the image is decoded
        image = split_images.get_split_image(session, splits.get_split(session, split), split_image_id)
    return thumbnail_answer(server, image.image_sha256, size, if_none_match)


@router.get("/splits/{split}/truth", response_class=Response, responses={**TRUTH})
def read_truth_file(
    server: ServerDep,
    session: Reader,
    viewer: ViewerDep,
    split: str,
    version: RowId | None = None,
    format: Literal["npz", "json"] = "npz",  # noqa: A002 - the word that users know
) -> Response:
    """Return the frozen labels in one file for all images, with verdicts ``keep`` and ``ambiguous``.

    JSON also has the candidates that were rejected with a reason, after the labels of an image.

    404 on hidden splits below maintainer.
    """
    found = splits.get_split(session, split)
    if not can_see_details(viewer, found.visibility):
        raise NotFound("there is nothing at this address", hint="the labels of a hidden split aren't shown")
    chosen = splits.get_version(session, found, version)
    name = f"{found.slug}-v{chosen.number}.{format}"
    headers = {"Content-Disposition": f'attachment; filename="{name}"', "X-Truth-Hash": chosen.truth_hash}
    if format == "npz":
        return Response(server.blobs.read(chosen.truth_sha256), media_type="application/x-npz", headers=headers)
    content = write_json_set(read_truth_with_reasons(session, server.blobs, chosen).items())
    return Response(content, media_type="application/json", headers=headers)
