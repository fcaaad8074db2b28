"""What a worker makes of a finished calibration: pictures, the difference to a reference, files, a report."""

from __future__ import annotations

import hashlib
import json
from typing import Annotated, Literal

from fastapi import APIRouter, Query, Response

from app.api.deps import Server, ServerDep
from app.api.freshness import IfNoneMatch, fresh_headers, is_held, not_modified
from app.api.problems import answers
from app.api.schemas.base import RowId
from app.api.schemas.calibration_results import ExportOverview, LensDifference
from app.db.models import Calibration, Camera
from app.errors import InvalidInput, NotFound
from app.jobs.calibration_answers import Focal, difference_task, export_task, overview_task, undistorted_task
from app.jobs.calibration_report import ReportInputs, report_task
from app.services.calibration_images import image_for, image_to_show, lens_of, view_of
from app.services.calibrations import camera_of, finished_calibration, images_of_calibration
from app.services.camera_references import reference_camera

router = APIRouter(prefix="/calibrations/{calibration_id}", tags=["cameras"], responses=answers(404, 409, 503))

REPORT_POLICY = (
    "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'; "
    "frame-ancestors 'self'"
)
"""The report has its style within it, and nothing else: no script, nothing loaded."""
BINARY = {"schema": {"type": "string", "format": "binary"}}
FocalLength = Annotated[float | None, Query(gt=0, le=1e6, description="px; else the estimated or a nominal one.")]
PrincipalPoint = Annotated[float | None, Query(ge=-1e6, le=1e6, description="Of the principal point, px.")]


@router.get(
    "/images/{image_id}/undistorted",
    response_class=Response,
    responses={200: {"content": {"image/jpeg": BINARY}}},
)
def read_undistorted(
    server: ServerDep,
    calibration_id: RowId,
    image_id: RowId,
    scale: Annotated[Literal["fit"], Query(description="The whole corrected frame, in the image's size.")] = "fit",
    if_none_match: IfNoneMatch = None,
) -> Response:
    """Return an image of the camera with this calibration's lens taken out; black where the image doesn't reach."""
    with server.database.read() as session:  # given back before the image is decoded
        row = finished_calibration(session, calibration_id)
        image = image_for(session, row, image_id)
    view_of(row)  # refuses a lens that can't be taken out before anything is read
    lens = lens_of(row).as_dict()
    of_lens = hashlib.sha256(json.dumps(lens, sort_keys=True).encode()).hexdigest()[:16]
    tag = f"{image.sha256}-undistorted-{scale}-{of_lens}"
    if is_held(if_none_match, tag):
        return not_modified(tag)
    most = server.settings.max_image_pixels

    def arguments() -> tuple[object, ...]:
        return server.blobs.read(image.sha256), image.name, lens, most

    seen = server.calibrations.answer(tag, image.name, undistorted_task, arguments)
    return Response(seen, media_type="image/jpeg", headers=fresh_headers(tag))


@router.get("/difference")
def read_difference(server: ServerDep, calibration_id: RowId) -> LensDifference:
    """Return how far the lens is from the camera's reference, over the frame."""
    row, camera = _finished(server, calibration_id)
    reference = reference_camera(camera)
    if reference is None:
        raise NotFound(
            f"the camera {camera.name} has no reference to compare with",
            hint="upload one: POST /api/cameras/ID/reference-file",
        )
    key = ("difference", calibration_id, reference)
    lens = lens_of(row).as_dict()
    found = server.calibrations.answer(key, camera.name, difference_task, lambda: (lens, reference))
    return LensDifference.model_validate(found)


@router.get("/exports")
def list_exports(
    server: ServerDep,
    calibration_id: RowId,
    focal_length: FocalLength = None,
    cx: PrincipalPoint = None,
    cy: PrincipalPoint = None,
) -> ExportOverview:
    """List the formats that the lens can be written in, with the error of each conversion."""
    row, camera = _finished(server, calibration_id)
    given = _focal(focal_length, cx, cy)
    key = ("exports", calibration_id, camera.name, given)
    arguments = (row.result, camera.name, given)
    found = server.calibrations.answer(key, camera.name, overview_task, lambda: arguments)
    return ExportOverview.model_validate(found)


@router.get("/exports/{format}", response_class=Response, responses={200: {"content": {"application/*": BINARY}}})
def export_calibration(
    server: ServerDep,
    calibration_id: RowId,
    format: str,  # noqa: A002 - the word that users know
    focal_length: FocalLength = None,
    cx: PrincipalPoint = None,
    cy: PrincipalPoint = None,
) -> Response:
    """Return the lens as a file that another tool reads, refitted to that tool's model over the frame.

    The header `X-Conversion-Error` tells what the refit lost, px. 422 with the code `cannot-export` where it is too
    much, with the formats that hold the lens in the hint.
    """
    row, camera = _finished(server, calibration_id)
    given = _focal(focal_length, cx, cy)
    key = ("export", calibration_id, format, camera.name, given)
    arguments = (row.result, format, camera.name, given)
    made = server.calibrations.answer(key, camera.name, export_task, lambda: arguments)
    headers = {
        "Content-Disposition": f'attachment; filename="{made.file_name}"',
        "X-Conversion-Error": f"rms={made.error.rms:.6g}, maximum={made.error.maximum:.6g}",
        "Cache-Control": "no-cache",
    }
    return Response(made.content, media_type=made.media_type, headers=headers)


@router.get("/report", response_class=Response, responses={200: {"content": {"text/html": BINARY}}})
def read_report(server: ServerDep, calibration_id: RowId) -> Response:
    """Return the calibration as a page to print: one file of HTML that loads nothing and runs no script."""
    with server.database.read() as session:  # given back before the image is decoded
        row = finished_calibration(session, calibration_id)
        camera = camera_of(session, row)
        image = image_to_show(session, row)
        reference = reference_camera(camera)
        images = tuple(images_of_calibration(row))

    def arguments() -> tuple[object, ...]:
        shown = image is not None and server.blobs.exists(image.sha256)
        picture = (image.name, server.blobs.read(image.sha256)) if image is not None and shown else None
        created = row.finished_at or row.created_at
        inputs = ReportInputs(row.result or {}, row.lines, images, camera.name, picture, reference, created)
        return inputs, server.settings.max_image_pixels

    key = ("report", calibration_id, camera.name, image and (image.name, image.sha256), reference)
    page = server.calibrations.answer(key, camera.name, report_task, arguments)
    headers = {"Content-Security-Policy": REPORT_POLICY, "Cache-Control": "no-cache"}
    return Response(page, media_type="text/html; charset=utf-8", headers=headers)


def _finished(server: Server, calibration_id: int) -> tuple[Calibration, Camera]:
    """Return a calibration and its camera; nobody who waits for the worker holds a session of the database."""
    with server.database.read() as session:
        row = finished_calibration(session, calibration_id)
        return row, camera_of(session, row)


def _focal(focal_length: float | None, cx: float | None, cy: float | None) -> Focal:
    if (cx is None) != (cy is None):
        missing = "cx" if cx is None else "cy"
        raise InvalidInput("half a principal point", where=missing, expected="cx and cy, or neither")
    return Focal(focal_length, None if cx is None or cy is None else (cx, cy))
