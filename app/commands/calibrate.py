"""``clearlines calibrate``: a lens for each camera of a folder, without server or database."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from pathlib import Path
from typing import Any

from app.calibration.calibrate import calibrate
from app.calibration.calibration import Calibration
from app.calibration.comparison import Difference, ReferenceLens, compare
from app.calibration.exports.catalog import FORMATS
from app.calibration.exports.export import Exported, ExportOption, export_lens, overview
from app.calibration.exports.intrinsics import Intrinsics, choose_intrinsics
from app.calibration.focal_estimate import FocalEstimate
from app.calibration.lens import CameraLens, Family
from app.commands.calibrate_sources import CameraLines, GatheredLines
from app.errors import CannotExport, ClearLinesError, InvalidInput
from app.formats.calibration_files import FILE_LIMIT, read_calibration_file
from app.formats.files import read_file
from app.formats.reference_camera import ReferenceCamera

Watch = Callable[[str, int, int], None]
SHORT_NAMES = {"opencv": "opencv-yaml"}


@dataclass(frozen=True)
class CalibrateChoice:
    """How to calibrate.

    Attributes:
        family: Lens family; ``None`` for the one that explains the lines best.
        focal_length: For files of other tools, px; ``None`` takes the estimated one, else a nominal one.
        exports: Keys of the formats to write.
        reference: File of a calibration to compare with; without it the dataset's own is taken, if it has one.
        seed: Of the draws of the uncertainty.
    """

    family: Family | None = None
    focal_length: float | None = None
    exports: tuple[str, ...] = ()
    reference: Path | None = None
    seed: int = 0

    def __post_init__(self) -> None:
        exports = dict.fromkeys(SHORT_NAMES.get(name, name) for name in self.exports)
        unknown = [name for name in exports if name not in FORMATS]
        if unknown:
            raise InvalidInput(f"{unknown[0]!r} is not possible", where="--export", expected=", ".join(FORMATS))
        object.__setattr__(self, "exports", tuple(exports))


@dataclass(frozen=True, eq=False)
class CalibratedCamera:
    """What came of one camera.

    Attributes:
        lines: What it was calibrated from.
        calibration: The result; perhaps not accepted.
        intrinsics: For files of other tools.
        exported: The files asked for, by format.
        refused: Why one of them isn't there, by format.
        difference: To the reference, if there is one.
        reference_name: What that is called.
    """

    lines: CameraLines
    calibration: Calibration
    intrinsics: Intrinsics
    exported: Mapping[str, Exported] = field(default_factory=dict)
    refused: Mapping[str, ClearLinesError] = field(default_factory=dict)
    difference: Difference | None = None
    reference_name: str = "reference"

    @cached_property
    def options(self) -> tuple[ExportOption, ...]:
        """How exactly each format holds the lens."""
        return tuple(overview(self.calibration.lens, self.intrinsics, calibration=self.calibration.as_dict()))

    @property
    def done(self) -> bool:
        """Whether the lens can be used and all files asked for are there."""
        return self.calibration.accepted and not self.refused

    def as_dict(self) -> dict[str, Any]:
        """Return what programs want to know, for JSON."""
        return {
            "camera": self.lines.name,
            "source": self.lines.source,
            "calibration": self.calibration.as_dict(),
            "intrinsics": {
                "focal_length": self.intrinsics.focal_length,
                "principal_point": list(self.intrinsics.principal_point),
                "source": self.intrinsics.source,
            },
            "exports": [option.as_dict() for option in self.options],
            "difference": None if self.difference is None else self.difference.as_dict(),
        }


def calibrate_cameras(
    gathered: GatheredLines, choice: CalibrateChoice, *, watch: Callable[[str], Watch] | None = None
) -> list[CalibratedCamera]:
    """Calibrate each camera; nothing is written.

    Args:
        gathered: The cameras' lines.
        choice: How.
        watch: Gives what is told of the stages, for a camera's name; may raise to stop.

    Raises:
        InvalidInput: If no camera has a line, the focal length is none, or the reference can't be compared.
        InvalidFile: If the reference can't be read.
    """
    if not any(len(image.segments) for camera in gathered.cameras for image in camera.images):
        raise InvalidInput("there is no line to calibrate from", hint="keep lines first, or give images without labels")
    if choice.focal_length is not None:
        for camera in gathered.cameras:
            identity = CameraLens.identity("brown", *camera.size)
            Intrinsics(choice.focal_length, identity.center, "given").require_plausible(identity)
    references = [_reference(choice.reference, camera) for camera in gathered.cameras]
    return [
        _calibrated(camera, choice, reference, _unwatched if watch is None else watch(camera.name))
        for camera, reference in zip(gathered.cameras, references, strict=True)
    ]


def _reference(file: Path | None, camera: CameraLines) -> ReferenceCamera | None:
    if file is None:
        return camera.reference
    data = read_file(file, limit=FILE_LIMIT)
    return read_calibration_file(data, where=str(file), size=camera.size, camera=camera.name)


def _calibrated(
    lines: CameraLines, choice: CalibrateChoice, reference: ReferenceCamera | None, watch: Watch
) -> CalibratedCamera:
    calibration = calibrate(lines.images, lines.size, family=choice.family, seed=choice.seed, watch=watch)
    intrinsics = intrinsics_of(calibration, choice.focal_length)
    camera = CalibratedCamera(lines, calibration, intrinsics)
    exported, refused = _exports(camera, choice.exports)
    difference = (
        None if reference is None else difference_to(reference, calibration.lens, asked=choice.reference is not None)
    )
    named = "cameras.json" if choice.reference is None else choice.reference.name
    return replace(camera, exported=exported, refused=refused, difference=difference, reference_name=named)


def intrinsics_of(calibration: Calibration, focal_length: float | None) -> Intrinsics:
    """Return what files of other tools state: a focal length that was given, else the calibration's, else a nominal."""
    estimate = None if calibration.focal is None else FocalEstimate.from_dict(calibration.focal)
    return choose_intrinsics(calibration.lens, focal_length=focal_length, estimate=estimate)


def difference_to(reference: ReferenceCamera, lens: CameraLens, *, asked: bool) -> Difference | None:
    """Compare with a reference; one that nobody asked for may be beyond comparing.

    Raises:
        InvalidInput: If one that was asked for is.
    """
    try:
        known = ReferenceLens(reference.matrix, reference.distortion)
        return compare(lens, known, lens.width, lens.height)
    except InvalidInput:
        if asked:
            raise
        return None


def _exports(
    camera: CalibratedCamera, formats: Sequence[str]
) -> tuple[dict[str, Exported], dict[str, ClearLinesError]]:
    """Make the files asked for, as far as the lens goes into them."""
    calibration = camera.calibration
    exported: dict[str, Exported] = {}
    refused: dict[str, ClearLinesError] = {}
    for name in formats:
        try:
            exported[name] = export_lens(
                calibration.lens, name, camera_name=camera.lines.name, intrinsics=camera.intrinsics,
                calibration=calibration.as_dict(),
            )  # fmt: skip
        except CannotExport as error:
            refused[name] = error
    return exported, refused


def _unwatched(stage: str, done: int, total: int) -> None:
    del stage, done, total
