"""Where the files of a calibration go: exports, JSON and report, each whole or not at all."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from datetime import datetime
from pathlib import Path
from typing import Any

from app import __version__
from app.calibration.exports.names import file_stem
from app.calibration.report.report import report_html
from app.commands.calibrate import CalibratedCamera
from app.commands.calibrate_pictures import report_pictures
from app.commands.whole_files import write_whole
from app.errors import InvalidInput


def require_outputs_possible(
    output: Path | None, report: Path | None, json: Path | None, exports: Sequence[str] = ()
) -> None:
    """Refuse places that no file can be written to, before anything is computed.

    Raises:
        InvalidInput: If a folder is where a file is to be written, or a file where a folder is needed.
    """
    _require_one_file_each(output, len(exports))
    for option, path in (("--report", report), ("--json", json)):
        if path is not None and path.is_dir():
            raise InvalidInput("a folder is where a file is to be written", where=f"{option} {path}", expected="a file")
    for path in (output, report, json):
        parent = next((each for each in ([] if path is None else path.parents) if each.exists()), None)
        if parent is not None and not parent.is_dir():
            raise InvalidInput("a file is where a folder is to be written", where=str(parent), expected="a folder")


def write_exports(cameras: Sequence[CalibratedCamera], output: Path | None) -> list[Path]:
    """Write the exported files: one to a file or folder, several to a folder; the working folder when left out.

    Raises:
        InvalidInput: If several files are to go into one.
        OSError: If they can't be written.
    """
    files = [(camera, exported) for camera in cameras for exported in camera.exported.values()]
    if not files:
        return []
    _require_one_file_each(output, len(files))
    if output is not None and _is_one_file(output):
        write_whole(output, files[0][1].content)
        return [output]
    stems = _stems(cameras)
    written: list[Path] = []
    for camera, exported in files:
        suffix = exported.file_name.removeprefix(file_stem(camera.lines.name))
        path = (output or Path()) / f"{stems[id(camera)]}{suffix}"
        write_whole(path, exported.content)
        written.append(path)
    return written


def _require_one_file_each(output: Path | None, files: int) -> None:
    if output is not None and files > 1 and _is_one_file(output):
        raise InvalidInput(f"{files} files can't be written into one", where=str(output), expected="a folder")


def _is_one_file(output: Path) -> bool:
    """Tell a file from a folder by what is there, else by whether its name has an ending."""
    return output.is_file() or (bool(output.suffix) and not output.is_dir())


def write_reports(cameras: Sequence[CalibratedCamera], path: Path, *, created: datetime) -> list[Path]:
    """Write the printable report of each camera; of several, the camera's name goes behind the file's.

    Raises:
        OSError: If it can't be written.
    """
    stems = _stems(cameras)
    written: list[Path] = []
    for camera in cameras:
        page = report_html(
            camera.calibration,
            camera_name=camera.lines.name,
            created=created,
            pictures=report_pictures(camera),
            difference=camera.difference,
            reference_name=camera.reference_name,
            intrinsics=camera.intrinsics,
            options=camera.options,
        )
        place = path if len(cameras) == 1 else path.with_stem(f"{path.stem}_{stems[id(camera)]}")
        write_whole(place, page.encode())
        written.append(place)
    return written


def json_content(cameras: Sequence[CalibratedCamera]) -> dict[str, Any]:
    """Return what ``--json`` writes."""
    return {"clearlines": __version__, "cameras": [camera.as_dict() for camera in cameras]}


def _stems(cameras: Sequence[CalibratedCamera]) -> dict[int, str]:
    """Return the beginning of each camera's file names; cameras that would share one get a number."""
    seen: Counter[str] = Counter()
    stems: dict[int, str] = {}
    for camera in cameras:
        stem = file_stem(camera.lines.name)
        seen[stem] += 1
        stems[id(camera)] = stem if seen[stem] == 1 else f"{stem}_{seen[stem]}"
    return stems
