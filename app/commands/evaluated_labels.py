"""What the label files of an evaluation say of an image: labels, ambiguous ones, and lines rejected with a reason."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from app.commands.segment_files import Read, SegmentFiles
from app.evaluation import GroundTruth, ground_truth
from app.evaluation.rejected_lines import RejectedLines
from app.formats.labelled import LabelledSegments
from app.verdicts import REASONS
from app.vision.segments import Segments


def read_labels(files: SegmentFiles, name: str, min_length: float) -> tuple[GroundTruth, RejectedLines | None]:
    """Return the labels of an image, and the segments that its file rejects with a reason, if any.

    Of a file with verdicts those kept are labels, the ambiguous ones being ignored.
    """
    ambiguous = read_plain(files.ambiguous, name)
    if name not in files.files:
        return ground_truth(Segments.empty(), ambiguous, min_length), None
    labelled = files.files[name]()
    if labelled.verdicts is None:
        return ground_truth(labelled.segments, ambiguous, min_length), None
    unsure = labelled.with_verdict("ambiguous").segments
    both = Segments.from_list([*unsure, *ambiguous])
    return ground_truth(labelled.with_verdict("keep").segments, both, min_length), _rejected(labelled)


def read_plain(files: Mapping[str, Read], name: str) -> Segments:
    """Return all segments of an image's file, none without one."""
    return files[name]().segments if name in files else Segments.empty()


def _rejected(labelled: LabelledSegments) -> RejectedLines | None:
    if labelled.reasons is None:
        return None
    given = {index: REASONS.index(reason) for index, reason in enumerate(labelled.reasons) if reason is not None}
    return RejectedLines(labelled.segments.select(list(given)), np.array(list(given.values()), np.int8))
