"""Images: list, change, delete and restore; their pixels."""

from __future__ import annotations

from typing import Annotated, Literal

from fastapi import APIRouter, Query, Response
from fastapi.responses import FileResponse

from app.api.deps import Cursor, Limit, Now, Reader, ServerDep, ViewerDep
from app.api.freshness import IfNoneMatch
from app.api.pixels import PIXELS, ThumbnailSize, display_answer, original_answer, thumbnail_answer, view_answer
from app.api.problems import answers
from app.api.schemas.base import ReviewState, RowId, Verdict
from app.api.schemas.datasets import Deleted, Restored
from app.api.schemas.images import (
    Facets,
    ImageChange,
    ImageDetail,
    ImageIds,
    ImagePage,
    ImagesChange,
    PrelabelState,
    Updated,
)
from app.services import image_changes, image_details, image_lists, images
from app.services.concealing import require_visible
from app.services.datasets import get_dataset
from app.services.image_views import View, viewed_image

router = APIRouter(tags=["images"], responses=answers(404))


Sort = Literal["name", "-name", "created", "-created", "candidates", "-candidates"]


@router.get("/datasets/{slug}/images")
def list_images(
    session: Reader,
    slug: str,
    status: ReviewState | None = None,
    source: str | None = None,
    camera: RowId | None = None,
    sequence: str | None = None,
    prelabel: PrelabelState | None = None,
    search: Annotated[str | None, Query(max_length=300, description="Part of the name.")] = None,
    assignee: Annotated[str | None, Query(max_length=200, description="Whose task; empty: nobody's.")] = None,
    person: Annotated[str | None, Query(max_length=200, description="Who decided on some candidates.")] = None,
    verdict: Annotated[Verdict | None, Query(description="Of at least one candidate.")] = None,
    min_score: Annotated[float | None, Query(ge=0, le=1, description="Of at least one candidate.")] = None,
    max_score: Annotated[float | None, Query(ge=0, le=1, description="Of at least one candidate.")] = None,
    sort: Sort = "name",
    deleted: bool = False,
    limit: Limit = 100,
    cursor: Cursor = None,
) -> ImagePage:
    """List the images of a dataset, page by page."""
    chosen = image_lists.ImageFilter(
        status=status,
        source=source,
        camera=camera,
        sequence=sequence,
        prelabel=prelabel,
        search=search,
        assignee=assignee,
        person=person,
        verdict=verdict,
        min_score=min_score,
        max_score=max_score,
        deleted=deleted,
    )
    dataset = get_dataset(session, slug)
    page = image_lists.list_images(session, dataset, chosen, sort=sort, limit=limit, cursor=cursor)
    return ImagePage.model_validate(page)


@router.get("/datasets/{slug}/facets")
def read_facets(session: Reader, slug: str) -> Facets:
    """Return what the images of a dataset can be filtered by, with counts."""
    return Facets.model_validate(image_lists.facets(session, get_dataset(session, slug)))


@router.patch("/datasets/{slug}/images")
def change_images(server: ServerDep, viewer: ViewerDep, now: Now, slug: str, given: ImagesChange) -> Updated:
    """Change camera, source or sequence of many images; all of them or none."""
    with server.database.write() as session:
        count = image_changes.update_images(
            session, get_dataset(session, slug), given.ids, _changes(given), now, person=viewer.name
        )
    return Updated(updated=count)


@router.post("/datasets/{slug}/images/delete")
def delete_images(server: ServerDep, viewer: ViewerDep, now: Now, slug: str, given: ImageIds) -> Deleted:
    """Delete many images; they can be restored during the grace period."""
    settings = server.settings
    with server.database.write() as session:
        dataset = get_dataset(session, slug)
        deleted = images.delete_images(session, dataset, given.ids, now, grace=settings.grace, person=viewer.name)
        return Deleted.model_validate(deleted)


@router.post("/datasets/{slug}/images/restore", responses=answers(409))
def restore_images(server: ServerDep, viewer: ViewerDep, now: Now, slug: str, given: ImageIds) -> Restored:
    """Bring deleted images back."""
    with server.database.write() as session:
        dataset = get_dataset(session, slug)
        count = images.restore_images(session, dataset, given.ids, now, person=viewer.name)
    server.dispatcher.wake()
    return Restored(restored=count)


@router.get("/images/{image_id}")
def read_image(session: Reader, viewer: ViewerDep, now: Now, image_id: RowId) -> ImageDetail:
    """Return an image with its neighbours, its lens and its run."""
    image = images.get_image(session, image_id)
    return ImageDetail.model_validate(image_details.image_detail(session, image, now, person=viewer.name))


@router.patch("/images/{image_id}", responses=answers(409))
def change_image(server: ServerDep, viewer: ViewerDep, now: Now, image_id: RowId, given: ImageChange) -> ImageDetail:
    """Rename an image, or change its camera, source or sequence."""
    with server.database.write() as session:
        image = images.get_image(session, image_id)
        dataset = images.dataset_of(session, image)
        image_changes.update_images(session, dataset, [image.id], _changes(given), now, person=viewer.name)
        if given.name is not None:
            image_changes.rename_image(session, image, given.name, now, person=viewer.name)
        session.refresh(image)
        return ImageDetail.model_validate(image_details.image_detail(session, image, now, person=viewer.name))


@router.delete("/images/{image_id}")
def delete_image(server: ServerDep, viewer: ViewerDep, now: Now, image_id: RowId) -> Deleted:
    """Delete an image; it can be restored during the grace period."""
    settings = server.settings
    with server.database.write() as session:
        image = images.get_image(session, image_id)
        dataset = images.dataset_of(session, image)
        deleted = images.delete_images(session, dataset, [image.id], now, grace=settings.grace, person=viewer.name)
        return Deleted.model_validate(deleted)


@router.get("/images/{image_id}/original", response_class=FileResponse)
def read_original(server: ServerDep, session: Reader, image_id: RowId, if_none_match: IfNoneMatch = None) -> Response:
    """Return the file as it was uploaded."""
    image = images.get_image(session, image_id)
    return original_answer(server, image.sha256, image.file_name, if_none_match)


@router.get("/images/{image_id}/display", response_class=Response, responses={**PIXELS, **answers(409)})
def read_display(
    server: ServerDep,
    viewer: ViewerDep,
    image_id: RowId,
    view: Annotated[
        View, Query(description="As stored; equalised (CLAHE); or with the lens's distortion taken out, in one size.")
    ] = "plain",
    if_none_match: IfNoneMatch = None,
) -> Response:
    """Return the image in a form that a browser shows, pixels as stored: no EXIF rotation, 16 bit brought to 8.

    The view ``undistorted`` answers 409 while the lens isn't known; ``points`` gives the candidates in the same view.
    """
    with server.database.read() as session:  # given back before the image is decoded
        if view == "undistorted":  # no pixels alone: the lens is learnt from the labels
            require_visible(session, viewer, {"image_id": str(image_id)})
        image = images.get_image(session, image_id)
        viewed = None if view == "plain" else viewed_image(session, image, view)
    if viewed is None:
        return display_answer(server, image.sha256, if_none_match)
    return view_answer(server, viewed, if_none_match)


@router.get("/images/{image_id}/thumbnail", response_class=Response, responses={**PIXELS})
def read_thumbnail(
    server: ServerDep,
    image_id: RowId,
    size: ThumbnailSize = ThumbnailSize.MEDIUM,
    if_none_match: IfNoneMatch = None,
) -> Response:
    """Return a small picture whose longer side is ``size`` px."""
    with server.database.read() as session:  # given back before the image is decoded
        sha256 = images.get_image(session, image_id).sha256
    return thumbnail_answer(server, sha256, size, if_none_match)


def _changes(given: ImagesChange | ImageChange) -> image_changes.ImageChanges:
    """Return the fields that the request names; ``null`` clears one, leaving it out doesn't."""
    named = given.model_fields_set & {"camera", "source", "sequence"}
    chosen = {name: getattr(given, name) for name in named}
    if chosen.get("camera", "") is None:
        del chosen["camera"]
    return image_changes.ImageChanges(**chosen)
