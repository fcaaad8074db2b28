"""A lens as a file of another tool, with the error of the conversion, or the reason why not."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from app.calibration.exports.catalog import FORMATS, ExportFormat
from app.calibration.exports.conversion import Conversion
from app.calibration.exports.draft import Draft
from app.calibration.exports.frame_sample import ConversionError, FrameSample, frame_sample
from app.calibration.exports.intrinsics import Intrinsics
from app.calibration.lens import CameraLens
from app.errors import CannotExport, InvalidInput

LIMIT = 0.5
"""px rms; a conversion that is further off is refused unless asked for."""


@dataclass(frozen=True)
class Exported:
    """A file.

    Attributes:
        content: Its bytes.
        file_name: ASCII, without separators.
        media_type: Of the content.
        error: Of the conversion, px of the measured image.
        model: Lens model in the file.
        intrinsics: As stated in the file.
        notes: What a reader must know, one sentence each; also in the file where it has comments or fields for it.
    """

    content: bytes
    file_name: str
    media_type: str
    error: ConversionError
    model: str
    intrinsics: Intrinsics
    notes: tuple[str, ...]


@dataclass(frozen=True)
class ExportOption:
    """Whether a lens can be written in a format.

    Attributes:
        format: Key of the format.
        title: For menus.
        error: Of the conversion; None if no fit holds.
        allowed: Whether it would be written.
        reason: Why not, or None.
        model: Lens model that the file would have, or None.
    """

    format: str
    title: str
    error: ConversionError | None
    allowed: bool
    reason: str | None
    model: str | None

    def as_dict(self) -> dict[str, Any]:
        """Return the option as JSON-serialisable fields."""
        return {
            "format": self.format,
            "title": self.title,
            "error": None if self.error is None else self.error._asdict(),
            "allowed": self.allowed,
            "reason": self.reason,
            "model": self.model,
        }


def export_lens(
    lens: CameraLens,
    format: str,  # noqa: A002 - the word of the commands and of the web interface
    *,
    camera_name: str,
    intrinsics: Intrinsics,
    limit: float = LIMIT,
    calibration: Mapping[str, Any] | None = None,
) -> Exported:
    """Write a lens in the format of another tool, refitted over the frame.

    Args:
        lens: The lens.
        format: Key of `FORMATS`.
        camera_name: Any text; what would break a file or its name is left out of it.
        intrinsics: Focal length and principal point to state.
        limit: Largest conversion error, px rms of the measured image.
        calibration: Of the lens, as ``Calibration.as_dict`` gives it; kept by ClearLines' own format. A refused lens
            goes into no other one: files of other tools have no place for the verdict.

    Raises:
        InvalidInput: If there is no such format, or the intrinsics belong to no camera of that size.
        CannotExport: If the format can't hold the lens within the limit, or the lens is refused.
    """
    if not limit >= 0:
        raise InvalidInput(f"{limit}", where="limit", expected="px, 0 or more")
    chosen = FORMATS.get(format)
    if chosen is None:
        raise InvalidInput(f"no format {format!r:.40}", where="format", expected=", ".join(FORMATS))
    if refusal := _refusal(chosen, calibration):
        raise CannotExport(
            refusal, where="lens", hint="clearlines holds the lens with its verdict; more lines may tell a lens"
        )
    sample = None if chosen.convert is None else frame_sample(lens, intrinsics)
    try:
        conversion = _convert(chosen, lens, sample)
        _require_within(conversion, limit)
    except CannotExport as error:
        raise CannotExport(
            f"{chosen.title} can't hold this lens: {error.message}",
            where=error.where,
            expected=error.expected,
            hint=_what_would_fit(chosen, lens, intrinsics, limit),
            details=error.details,
        ) from None
    draft = Draft(lens, intrinsics, camera_name, conversion, calibration)
    return Exported(
        chosen.write(draft),
        chosen.file_name(camera_name),
        chosen.media_type,
        conversion.error,
        conversion.model,
        intrinsics,
        draft.lines,
    )


def overview(
    lens: CameraLens,
    intrinsics: Intrinsics,
    limit: float = LIMIT,
    *,
    calibration: Mapping[str, Any] | None = None,
) -> list[ExportOption]:
    """Tell for each format whether, and how exactly, it can hold a lens; nothing is written.

    Args:
        lens: The lens.
        intrinsics: Focal length and principal point that would be stated.
        limit: Largest conversion error, px rms of the measured image.
        calibration: Of the lens, see `export_lens`.

    Raises:
        InvalidInput: If the intrinsics belong to no camera of that image size.
    """
    try:
        sample, unfit = frame_sample(lens, intrinsics), None
    except CannotExport as error:
        sample, unfit = None, error
    options = [_option(each, lens, sample, unfit, limit) for each in FORMATS.values()]
    refusals = [_refusal(each, calibration) for each in FORMATS.values()]
    return [
        option if refusal is None else replace(option, allowed=False, reason=refusal)
        for option, refusal in zip(options, refusals, strict=True)
    ]


def _refusal(chosen: ExportFormat, calibration: Mapping[str, Any] | None) -> str | None:
    if calibration is None or calibration["accepted"] or chosen.convert is None:
        return None
    return f"the lens isn't good enough to be used: {'; '.join(calibration['reasons'])}"


def _option(
    chosen: ExportFormat, lens: CameraLens, sample: FrameSample | None, unfit: CannotExport | None, limit: float
) -> ExportOption:
    try:
        if unfit is not None and chosen.convert is not None:
            raise unfit
        conversion = _convert(chosen, lens, sample)
    except CannotExport as error:
        return ExportOption(chosen.name, chosen.title, None, False, error.message, None)
    try:
        _require_within(conversion, limit)
    except CannotExport as error:
        return ExportOption(chosen.name, chosen.title, conversion.error, False, error.message, conversion.model)
    return ExportOption(chosen.name, chosen.title, conversion.error, True, None, conversion.model)


def _convert(chosen: ExportFormat, lens: CameraLens, sample: FrameSample | None) -> Conversion:
    if chosen.convert is None or sample is None:
        return Conversion(f"{lens.family}, as it is", lens.parameters, ConversionError(0.0, 0.0))
    return chosen.convert(sample)


def _what_would_fit(chosen: ExportFormat, lens: CameraLens, intrinsics: Intrinsics, limit: float) -> str:
    fitting = [each.format for each in overview(lens, intrinsics, limit) if each.allowed]
    hint = f"these can: {', '.join(fitting)}"
    centered = replace(intrinsics, principal_point=lens.center)
    options = overview(lens, centered, limit) if centered != intrinsics else []
    if any(each.format == chosen.name and each.allowed for each in options):
        x, y = lens.center
        hint += f"; {chosen.name} too with the principal point at the distortion centre ({x:.1f}, {y:.1f})"
    return hint


def _require_within(conversion: Conversion, limit: float) -> None:
    if not conversion.error.rms <= limit:
        raise CannotExport(
            f"its model ({conversion.model}) stays {conversion.error.told} away over the frame",
            expected=f"at most {limit:g} px rms",
            details=conversion.error._asdict(),
        )
