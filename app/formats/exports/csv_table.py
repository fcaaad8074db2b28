"""Two tables: ``segments.csv`` with a row per segment, ``points.csv`` with a row per point.

Coordinates are ours: px, x right, y down, pixel centre at integers.
"""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator

from app.formats.decimals import shortest
from app.formats.exports.polyline import attributes
from app.formats.labelled_image import LabelledImage

SEGMENT_COLUMNS = ("image", "segment", "points", "length", "verdict", "score", "straightness", "origin", "id")
POINT_COLUMNS = ("image", "segment", "x", "y")


def export_csv(images: Iterable[LabelledImage]) -> Iterator[tuple[str, bytes]]:
    """Yield both tables; ``image`` and ``segment`` (from 0, within the image) join them, ``length`` is in px."""
    segment_rows, point_rows = io.StringIO(newline=""), io.StringIO(newline="")
    segment_writer = csv.writer(segment_rows, lineterminator="\n")
    point_writer = csv.writer(point_rows, lineterminator="\n")
    segment_writer.writerow(SEGMENT_COLUMNS)
    point_writer.writerow(POINT_COLUMNS)
    for image in images:
        segments = image.labelled.segments
        facts = zip(segments.counts.tolist(), segments.lengths().tolist(), attributes(image.labelled), strict=True)
        for number, (count, length, known) in enumerate(facts):
            fields = (known.get(column, "") for column in SEGMENT_COLUMNS[4:])
            segment_writer.writerow((image.name, number, count, round(length, 3), *fields))
        points, owners = shortest(segments.points).tolist(), segments.segment_of_point.tolist()
        point_writer.writerows((image.name, owner, x, y) for owner, (x, y) in zip(owners, points, strict=True))
    yield "segments.csv", segment_rows.getvalue().encode()
    yield "points.csv", point_rows.getvalue().encode()
