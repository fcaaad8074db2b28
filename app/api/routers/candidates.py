"""Predictions of any detector, imported as candidates."""

from __future__ import annotations

from dataclasses import asdict
from typing import Annotated

from fastapi import APIRouter, File, UploadFile

from app.api.deps import Now, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.candidates import CandidatesImported
from app.api.schemas.submissions import LeftOutFile
from app.formats.npz import read_npz_set
from app.services.candidate_imports import images_to_predict, import_candidates
from app.services.datasets import get_dataset
from app.services.submission_intake import one_upload
from app.services.submission_limits import submission_limits
from app.services.uploads import UploadedFile

router = APIRouter(tags=["labelling"], responses=answers(404))


@router.post("/datasets/{slug}/candidates", responses=answers(413, 503))
def add_candidates(
    server: ServerDep,
    viewer: ViewerDep,
    now: Now,
    slug: str,
    files: Annotated[
        list[UploadFile],
        File(description="One .zip or .tar.gz of a file per image, one .npz or .json for all, or a file per image."),
    ],
) -> CandidatesImported:
    """Import any detector's predictions as undecided candidates, in the form of submissions.

    Sending the same again changes nothing. 422 with everything that is wrong with the files: `details.errors` has
    `file`, `segment`, `point`, `message`, `expected`, `hint`.
    """
    with server.database.read() as session:
        dataset = get_dataset(session, slug)
        images = images_to_predict(session, dataset)
    given = [UploadedFile(file.filename or "", file.file) for file in files]
    with one_upload(given, submission_limits(server.settings)) as upload:
        found = server.desk.validations.validate(upload.stream.read(), upload.name, images)
        name = upload.name
    predictions = read_npz_set(found.content, where=name)
    report = import_candidates(server.database, dataset.id, predictions, name, now, person=viewer.name)
    left_out = [LeftOutFile(file=file, reason=reason) for file, reason in found.left_out]
    return CandidatesImported(**asdict(report), left_out=left_out)
