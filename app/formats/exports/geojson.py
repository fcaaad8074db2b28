"""GeoJSON: ``NAME.geojson`` per image, one ``LineString`` feature per segment.

Coordinates are ours: px, x right and y *down*, the centre of the first pixel at (0, 0). RFC 7946 means degrees on the
globe; a map program must be told to take them as plain plane coordinates, and shows them upside down.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from app.formats.exports.polyline import attributes, dump, polylines
from app.formats.labelled_image import LabelledImage


def export_geojson(images: Iterable[LabelledImage]) -> Iterator[tuple[str, bytes]]:
    """Yield one feature collection per image; ``properties`` hold the segment's number and what is known of it."""
    for image in images:
        yield f"{image.name}.geojson", dump(_collection(image)).encode()


def _collection(image: LabelledImage) -> dict[str, Any]:
    lines = zip(polylines(image.labelled), attributes(image.labelled), strict=True)
    return {
        "type": "FeatureCollection",
        "image": {"file_name": image.file_name, "width": image.width, "height": image.height},
        "coordinates": "px, x right, y down, pixel centre at integers",
        "features": [
            {
                "type": "Feature",
                "geometry": {"type": "LineString", "coordinates": line.tolist()},
                "properties": {"segment": number, **known},
            }
            for number, (line, known) in enumerate(lines)
        ],
    }
