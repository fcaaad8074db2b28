"""The files of a submission that can be downloaded."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from app.db.models import Submission
from app.errors import NotFound
from app.services.access import Viewer, can_maintain
from app.services.submission_access import is_mine
from app.services.submission_views import can_download

SubmissionFile = Literal["npz", "upload"]


@dataclass(frozen=True)
class StoredFile:
    """A blob and the name that it is given."""

    sha256: str
    name: str


def submission_file(submission: Submission, viewer: Viewer, form: SubmissionFile) -> StoredFile:
    """Return a submission's segments, or its upload, which only its author and maintainers may have.

    Raises:
        NotFound: When there is none, or it isn't the viewer's to see.
    """
    base = f"submission-{submission.id}"
    inside = is_mine(viewer, submission.person) or can_maintain(viewer)
    if form == "upload" and inside and submission.upload_sha256 is not None:
        name = (submission.upload_name or "").lower()
        ending = ".tar.gz" if name.endswith((".tar.gz", ".tgz")) else name[name.rfind(".") :]
        return StoredFile(submission.upload_sha256, f"{base}-upload{ending if ending.isascii() else ''}")
    if form == "npz" and can_download(viewer, submission) and submission.segments_sha256 is not None:
        return StoredFile(submission.segments_sha256, f"{base}.npz")
    raise NotFound(f"submission {submission.id} has no such file to show")
