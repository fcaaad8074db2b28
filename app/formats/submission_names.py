"""Which image of a split a file of an upload is for: by name alone, with help where a name is almost right."""

from __future__ import annotations

import difflib
from collections.abc import Collection, Sequence
from pathlib import PurePosixPath

from app.formats.naming import FILTERED
from app.formats.raw_segments import RawSegments
from app.formats.submission_problems import Complaints, Problem

ALIKE = 0.8


def match_names(found: Sequence[RawSegments], names: Collection[str], complaints: Complaints) -> dict[str, RawSegments]:
    """Find each image's segments; names that the split doesn't know, and a second file for an image, are complained of.

    A file for image ``NAME`` is called ``NAME`` or ``NAME_edge_segments_filtered``; folders that enclose all files may
    stand before it.

    Args:
        found: What was read.
        names: Of the split's images.
        complaints: Gets what is wrong.
    """
    known = set(names)
    depth = _enclosing(found, known)
    matched: dict[str, RawSegments] = {}
    for segments in found:
        name = _image_of(segments, known, depth)
        if name is None:
            # a hint takes a while, and beyond the limit nobody is told it
            hint = _nearest(segments.name, known) if complaints.has_room else None
            expected = "the name of one of the images, or that and " + FILTERED
            complaints.add(Problem("there is no image of this name", segments.file, expected=expected, hint=hint))
        elif name in matched:
            message = f"a second file for the image {name}; the first is {matched[name].file}"
            complaints.add(Problem(message, segments.file, expected="one file for each image"))
        else:
            matched[name] = segments
    return matched


def _image_of(segments: RawSegments, known: set[str], depth: int) -> str | None:
    name = segments.name if segments.named else segments.name.split("/", depth)[-1]
    for candidate in (name, name.removesuffix(FILTERED)):
        if candidate in known:
            return candidate
    return None


def _enclosing(found: Sequence[RawSegments], known: set[str]) -> int:
    """Return how many folders that enclose all files are no part of the names: the fewest that make a name known."""
    files = [segments for segments in found if not segments.named]
    parents = [PurePosixPath(segments.name).parent.parts for segments in files]
    common = 0
    while parents and all(len(parts) > common and parts[common] == parents[0][common] for parts in parents):
        common += 1
    for depth in range(common + 1):
        if any(_image_of(segments, known, depth) is not None for segments in files):
            return depth
    return 0


def _nearest(name: str, known: set[str]) -> str | None:
    plain = name.removesuffix(FILTERED)
    same = [other for other in known if other.casefold() == plain.casefold()]
    same = same or [other for other in known if other.rpartition("/")[2] == plain.rpartition("/")[2]]
    # a comparison with every name of a large split, for each of many files, would take long
    same = same or (difflib.get_close_matches(plain[:200], known, 1, ALIKE) if len(known) <= 500 else [])
    return f"is it {min(same)}?" if same else None
