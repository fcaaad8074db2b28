"""Truth of a split: labels of many images in one file, and the hash that names exactly these labels."""

from __future__ import annotations

import hashlib
import struct
from collections.abc import Mapping

import numpy as np

from app.db.models import SplitVersion
from app.evaluation.ground_truth import GroundTruth
from app.formats.labelled import LabelledSegments
from app.formats.npz import read_npz_set
from app.storage import BlobStore

HASHED_FORM = b"clearlines-truth-1"
MEDIA_TYPE = "application/x-npz"


def truth_hash(truth: Mapping[str, LabelledSegments], min_length: float) -> str:
    """Return the SHA-256 of names, labels, their verdicts and the minimum length; the order of labels doesn't matter.

    Args:
        truth: Labels with the verdicts ``keep`` and ``ambiguous`` by image name.
        min_length: Of the split, px.
    """
    digest = hashlib.sha256(HASHED_FORM + struct.pack("<dQ", min_length, len(truth)))
    for name in sorted(truth):
        labels = sorted(_label_bytes(truth[name]))
        text = name.encode()
        digest.update(struct.pack("<QQ", len(text), len(labels)) + text)
        for label in labels:
            digest.update(struct.pack("<Q", len(label)) + label)
    return digest.hexdigest()


def read_truth(blobs: BlobStore, version: SplitVersion) -> Mapping[str, LabelledSegments]:
    """Return the frozen labels of each image, with the verdicts ``keep`` and ``ambiguous``.

    Raises:
        NotFound: When the file is gone from the data folder.
    """
    return read_npz_set(blobs.read(version.truth_sha256), where=f"truth of version {version.number}")


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
