"""Read an uploaded submission: any accepted form in, one checked form out, or every complaint at once."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import BinaryIO

from app.formats.labelled import LabelledSegments
from app.formats.npz import write_npz_set
from app.formats.raw_segments import RawSegments, read_raw
from app.formats.submission_checks import check_segments
from app.formats.submission_limits import SUBMISSION_LIMITS, SubmissionLimits
from app.formats.submission_members import ACCEPTED, LeftOut, read_members
from app.formats.submission_names import match_names
from app.formats.submission_problems import Complaints, Problem
from app.vision.segments import Segments


@dataclass(frozen=True)
class ExpectedImage:
    """An image of the split: its name, and its size in px."""

    name: str
    width: int
    height: int


@dataclass(frozen=True, eq=False)
class SubmissionContent:
    """A submission that can be scored.

    Attributes:
        segments: Of each image that the upload has a file for, in the split's order.
        has_scores: Whether every segment has a score; without any segment, no.
        missing: Names of images without a file: they count as empty.
        left_out: Files that weren't read.
        warnings: What is allowed but may not be meant.
    """

    segments: Mapping[str, Segments]
    has_scores: bool
    missing: tuple[str, ...]
    left_out: tuple[LeftOut, ...]
    warnings: tuple[str, ...]

    @property
    def n_segments(self) -> int:
        """Segments of all images."""
        return sum(len(segments) for segments in self.segments.values())

    @property
    def n_points(self) -> int:
        """Points of all segments."""
        return sum(len(segments.points) for segments in self.segments.values())


def read_submission(
    name: str,
    stream: BinaryIO,
    size: int,
    images: Sequence[ExpectedImage],
    limits: SubmissionLimits = SUBMISSION_LIMITS,
) -> SubmissionContent:
    """Read an upload for a split.

    Args:
        name: Its file name; the ending says what it is.
        stream: Its bytes, seekable, from the first.
        size: Their number.
        images: The split's.
        limits: How much is taken.

    Raises:
        InvalidSubmission: With everything that is wrong, over a limit too.
    """
    complaints = Complaints(limits.problems)
    left_out: list[LeftOut] = []
    found = _read_all(name, stream, size, limits, complaints, left_out)
    matched = match_names(found, [image.name for image in images], complaints)
    checked: dict[str, Segments] = {}
    for image in images:
        if image.name in matched:
            segments = check_segments(matched[image.name], (image.width, image.height), limits, complaints)
            checked[image.name] = segments or Segments.empty()
    if not matched and not complaints.count:
        complaints.add(Problem("there is no file for any of the images", name, expected=ACCEPTED))
    complaints.raise_any(name)
    missing = tuple(image.name for image in images if image.name not in matched)
    filled = [segments for segments in checked.values() if len(segments)]
    scored = sum(segments.scores is not None for segments in filled)
    return SubmissionContent(
        checked,
        bool(filled) and scored == len(filled),
        missing,
        tuple(left_out),
        _warnings(missing, len(filled), scored),
    )


def canonical_form(content: SubmissionContent) -> bytes:
    """Return the segments as one npz for all images: what is stored and scored, whatever form the upload had."""
    return write_npz_set(
        (name, LabelledSegments(_with_scores(segments, content.has_scores)))
        for name, segments in content.segments.items()
    )


def content_hash(content: SubmissionContent) -> str:
    """Return SHA-256 in hexadecimal of names, points and scores: equal results have equal hashes, however packed."""
    digest = hashlib.sha256()
    for name in sorted(content.segments):
        segments = _with_scores(content.segments[name], content.has_scores)
        parts = [name.encode(), segments.offsets.astype("<i8").tobytes(), segments.points.astype("<f4").tobytes()]
        parts += [] if segments.scores is None else [segments.scores.astype("<f4").tobytes()]
        for part in parts:
            digest.update(len(part).to_bytes(8, "little") + part)
    return digest.hexdigest()


def _with_scores(segments: Segments, has_scores: bool) -> Segments:
    return segments if has_scores else Segments(segments.points, segments.offsets)


def _read_all(
    name: str,
    stream: BinaryIO,
    size: int,
    limits: SubmissionLimits,
    complaints: Complaints,
    left_out: list[LeftOut],
) -> list[RawSegments]:
    found: list[RawSegments] = []
    segments = points = 0
    for path, data in read_members(name, stream, size, limits, complaints, left_out):
        read = read_raw(path, data, limits, complaints)
        segments += sum(len(image.counts) for image in read)
        points += sum(len(image.points) for image in read)
        for number, limit, what in ((segments, limits.segments, "segments"), (points, limits.points, "points")):
            if number > limit:
                message = f"the upload has more than {limit:,} {what}"
                complaints.add(Problem(message, path, expected=f"at most {limit:,} in all images together"))
                return found
        found += read
    return found


def _warnings(missing: Sequence[str], filled: int, scored: int) -> tuple[str, ...]:
    said = []
    if missing:
        said.append(f"{len(missing)} images have no file and count as empty")
    if not filled:
        said.append("there is no segment in any image")
    elif 0 < scored < filled:
        said.append("not all images have scores, so none is used and there is no AP")
    return tuple(said)
