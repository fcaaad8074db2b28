"""Uploads: images, labels and zips of them."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, File, UploadFile, status

from app.api.deps import Now, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.images import UploadReport
from app.services.datasets import get_dataset
from app.services.import_limits import import_limits
from app.services.imports import Importer
from app.services.uploads import UploadedFile, import_upload

router = APIRouter(tags=["images"], responses=answers(404, 413))


@router.post("/datasets/{slug}/images", status_code=status.HTTP_201_CREATED)
def upload_images(
    server: ServerDep,
    viewer: ViewerDep,
    now: Now,
    slug: str,
    files: Annotated[list[UploadFile], File(description="Images, label files, or zips; names may be paths.")],
) -> UploadReport:
    """Add images to a dataset: one, many, or zips.

    A file name may be a path, `KITTI/000000.png`. A zip in the ClearLines dataset layout brings its labels,
    `images.csv` and `cameras.json` too. What is there already is left as it is. A file that can't be used fails alone,
    with its reason; if none can be used the answer is 422 and `details.failed` names each.
    """
    settings = server.settings
    with server.database.read() as session:
        dataset = get_dataset(session, slug)
    importer = Importer(server.database, server.blobs, dataset.id, now, import_limits(settings), viewer.name)
    given = [UploadedFile(file.filename or "", file.file) for file in files]
    return UploadReport.model_validate(import_upload(importer, given))
