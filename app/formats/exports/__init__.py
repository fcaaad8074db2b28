"""Labels for other tools, by name of the format.

An exporter takes images with their segments and yields (path, content) pairs, for `app.formats.members` to put into a
folder or a zip. Segments are written with whatever is known of them; which of them to write is the caller's choice.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from types import MappingProxyType

from app.formats.dataset import write_dataset
from app.formats.exports.clearlines import export_json, export_npz
from app.formats.exports.coco import export_coco
from app.formats.exports.csv_table import export_csv
from app.formats.exports.cvat import export_cvat
from app.formats.exports.datumaro import export_datumaro
from app.formats.exports.geojson import export_geojson
from app.formats.exports.labelme import export_labelme
from app.formats.labelled_image import LabelledImage

Exporter = Callable[[Iterable[LabelledImage]], Iterator[tuple[str, bytes]]]

EXPORTS: Mapping[str, Exporter] = MappingProxyType(
    {
        "clearlines": write_dataset,
        "npz": export_npz,
        "json": export_json,
        "coco": export_coco,
        "cvat": export_cvat,
        "datumaro": export_datumaro,
        "labelme": export_labelme,
        "geojson": export_geojson,
        "csv": export_csv,
    }
)

__all__ = ["EXPORTS", "Exporter"]
