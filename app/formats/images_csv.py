"""``images.csv``: camera, source and sequence of each image."""

from __future__ import annotations

import csv
import io
from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

from app.errors import InvalidFile
from app.formats.naming import composed, has_control_characters, is_image_path, name_of
from app.formats.polylines import check_file_size

COLUMNS = ("name", "camera", "source", "sequence")
FILE_LIMIT = 16 * 2**20
WORD_LIMIT = 300


@dataclass(frozen=True)
class ImageRow:
    """What ``images.csv`` says of one image; empty where it says nothing."""

    camera: str = ""
    source: str = ""
    sequence: str = ""


def read_images_csv(data: bytes, images: Collection[str], *, where: str = "images.csv") -> Mapping[str, ImageRow]:
    """Read ``name,camera,source,sequence``; columns in any order, all but ``name`` optional, others ignored.

    Args:
        data: The file, UTF-8.
        images: Names of the images; in the file they may have their extension.
        where: The file, for messages.

    Returns:
        Row by name, for the images that are listed.

    Raises:
        InvalidFile: On names that no image has (all are named), a name listed twice, a line with too many fields.
        TooLarge: Over 16 MiB.
    """
    check_file_size(len(data), where=where, limit=FILE_LIMIT)
    try:
        lines = list(csv.DictReader(io.StringIO(data.decode("utf-8-sig"), newline=""), strict=True))
    except (UnicodeDecodeError, csv.Error) as error:
        raise InvalidFile(f"the table can't be read: {error}", where=where, expected="CSV in UTF-8") from error
    if lines and "name" not in lines[0]:
        raise InvalidFile("there is no column name", where=where, expected=",".join(COLUMNS))
    rows: dict[str, ImageRow] = {}
    unknown: list[str] = []
    for number, line in enumerate(lines, start=2):
        here = f"{where}: row {number}"
        if None in line:
            raise InvalidFile("the row has more fields than the header", where=here, expected=",".join(COLUMNS))
        name = _known_name(composed((line["name"] or "").strip()), images)
        if name in rows:
            raise InvalidFile(f"{name} is listed twice", where=here)
        if name not in images:
            unknown.append(name)
        rows[name] = ImageRow(*(_word(line.get(column), f"{here}, {column}") for column in COLUMNS[1:]))
    if unknown:
        raise InvalidFile(
            f"no image is called {', '.join(unknown[:20])}" + (" ..." if len(unknown) > 20 else ""),
            where=where,
            expected="paths under images/ without extension, such as KITTI/000000",
            details={"unknown": unknown[:1000]},
        )
    return rows


def write_images_csv(rows: Iterable[tuple[str, ImageRow]]) -> bytes:
    """Write the table, given (name, row)."""
    stream = io.StringIO(newline="")
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(COLUMNS)
    writer.writerows((name, row.camera, row.source, row.sequence) for name, row in rows)
    return stream.getvalue().encode()


def _known_name(name: str, images: Collection[str]) -> str:
    return name_of(name) if name not in images and is_image_path(name) else name


def _word(value: str | None, where: str) -> str:
    word = (value or "").strip()
    if len(word) > WORD_LIMIT or has_control_characters(word):
        raise InvalidFile(
            "the text is too long or has control characters", where=where, expected=f"at most {WORD_LIMIT} characters"
        )
    return word
