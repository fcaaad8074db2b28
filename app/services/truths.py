"""Truth of a split: labels of many images in one file, and the hash that names exactly these labels."""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Mapping

import numpy as np
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.db.models import SplitImage, SplitVersion
from app.evaluation.ground_truth import GroundTruth
from app.evaluation.rejected_lines import RejectedLines, reason_name
from app.formats.labelled import LabelledSegments
from app.formats.npz import read_npz_set
from app.storage import BlobStore
from app.vision.segments import Segments

HASHED_FORM = b"clearlines-truth-1"
HASHED_REJECTED = b"rejected-1"
MEDIA_TYPE = "application/x-npz"


def truth_hash(
    truth: Mapping[str, LabelledSegments], min_length: float, rejected: Mapping[str, RejectedLines] | None = None
) -> str:
    """Return the SHA-256 of names, labels, their verdicts and the minimum length; the order of labels doesn't matter.

    Args:
        truth: Labels with the verdicts ``keep`` and ``ambiguous`` by image name.
        min_length: Of the split, px.
        rejected: Candidates rejected with a reason, by image name; a truth without any has the hash of its labels.
    """
    digest = hashlib.sha256(HASHED_FORM + struct.pack("<dQ", min_length, len(truth)))
    for name in sorted(truth):
        labels = sorted(_label_bytes(truth[name]))
        text = name.encode()
        digest.update(struct.pack("<QQ", len(text), len(labels)) + text)
        for label in labels:
            digest.update(struct.pack("<Q", len(label)) + label)
    for name, lines in sorted((rejected or {}).items()):
        text = name.encode()
        digest.update(HASHED_REJECTED + struct.pack("<QQ", len(text), len(lines.segments)) + text)
        for line in sorted(_rejected_bytes(lines)):
            digest.update(struct.pack("<Q", len(line)) + line)
    return digest.hexdigest()


def read_truth(blobs: BlobStore, version: SplitVersion) -> Mapping[str, LabelledSegments]:
    """Return the frozen labels of each image, with the verdicts ``keep`` and ``ambiguous``.

    Raises:
        NotFound: When the file is gone from the data folder.
    """
    return read_npz_set(blobs.read(version.truth_sha256), where=f"truth of version {version.number}")


def read_rejected(session: Session, version: SplitVersion) -> dict[str, RejectedLines]:
    """Return the frozen candidates that were rejected with a reason, of the images that have any."""
    query = select(SplitImage.name, SplitImage.rejected).where(
        SplitImage.version_id == version.id, SplitImage.rejected.is_not(None)
    )
    return {row.name: RejectedLines.from_npz(row.rejected) for row in session.execute(query)}


def read_truth_with_reasons(session: Session, blobs: BlobStore, version: SplitVersion) -> dict[str, LabelledSegments]:
    """Return what `read_truth` does, and after an image's labels the candidates that were rejected with a reason."""
    rejected, truth = read_rejected(session, version), read_truth(blobs, version)
    return {name: _with_rejected(part, rejected[name]) if name in rejected else part for name, part in truth.items()}


def ground_truths(truth: Mapping[str, LabelledSegments], min_length: float) -> dict[str, GroundTruth]:
    """Return what predictions are scored against, label by label in the truth's order.

    Args:
        truth: As `read_truth` returns it.
        min_length: Of the split, px; shorter labels are ignored, as ambiguous ones are.
    """
    return {name: _ground_truth(labelled, min_length) for name, labelled in truth.items()}


def counted_labels(labelled: LabelledSegments, min_length: float) -> int:
    """Return how many labels of an image are there to be found: neither ambiguous nor too short."""
    return int((~_ground_truth(labelled, min_length).ignored).sum())


def _ground_truth(labelled: LabelledSegments, min_length: float) -> GroundTruth:
    verdicts = labelled.verdicts or (None,) * len(labelled)
    ambiguous = np.array([verdict == "ambiguous" for verdict in verdicts], dtype=bool)
    return GroundTruth(labelled.segments, ambiguous | (labelled.segments.lengths() < min_length))


def _label_bytes(labelled: LabelledSegments) -> list[bytes]:
    verdicts = labelled.verdicts or (None,) * len(labelled)
    return [
        (b"a" if verdict == "ambiguous" else b"k") + np.ascontiguousarray(points, "<f4").tobytes()
        for points, verdict in zip(labelled.segments, verdicts, strict=True)
    ]


def _with_rejected(labelled: LabelledSegments, rejected: RejectedLines) -> LabelledSegments:
    labels, others = len(labelled), len(rejected.segments)
    return LabelledSegments(
        Segments.from_list([*labelled.segments, *rejected.segments]),
        verdicts=(*(labelled.verdicts or (None,) * labels), *("reject",) * others),
        reasons=(*(None,) * labels, *map(reason_name, rejected.reasons.tolist())),
    )


def _rejected_bytes(rejected: RejectedLines) -> list[bytes]:
    return [
        bytes([reason]) + np.ascontiguousarray(points, "<f4").tobytes()
        for points, reason in zip(rejected.segments, rejected.reasons.tolist(), strict=True)
    ]
