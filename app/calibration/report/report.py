"""The printable report of a calibration."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from app import __version__
from app.calibration.calibration import Calibration
from app.calibration.comparison import Difference
from app.calibration.exports.conversion import Conversion
from app.calibration.exports.export import ExportOption, overview
from app.calibration.exports.frame_sample import frame_sample
from app.calibration.exports.intrinsics import Intrinsics, choose_intrinsics
from app.calibration.exports.opencv_storage import convert_opencv
from app.calibration.focal_length import FocalEstimate
from app.calibration.report.figures import MOST_IMAGES, difference_figure, free_figure, lens_figures
from app.calibration.report.tables import export_rows, ladder_rows, opencv_rows, parameter_rows, worst_lines
from app.calibration.report.words import ADVICE, FAMILY_TITLES, pixels, tiny_pixels, verdict
from app.errors import CannotExport

TEMPLATES = Path(__file__).with_name("templates")


@dataclass(frozen=True)
class ReportPicture:
    """A photo for the report.

    Attributes:
        caption: What it shows.
        content: The file's bytes; about 1300 px across is as fine as paper shows.
        media_type: Of the content.
    """

    caption: str
    content: bytes
    media_type: str = "image/jpeg"

    @property
    def source(self) -> str:
        """The picture as a data URI."""
        return f"data:{self.media_type};base64,{base64.b64encode(self.content).decode()}"


def report_html(
    calibration: Calibration,
    *,
    camera_name: str,
    created: datetime,
    pictures: Sequence[ReportPicture] = (),
    difference: Difference | None = None,
    reference_name: str = "reference",
    intrinsics: Intrinsics | None = None,
    options: Sequence[ExportOption] | None = None,
) -> str:
    """Write the report as one page of HTML for A4 paper: nothing is loaded, no script, all text escaped.

    Args:
        calibration: With its `lines`, if single lines and the spread of residuals are to be shown.
        camera_name: Of the camera.
        created: When the calibration was made.
        pictures: Photos, as before and after the correction.
        difference: To a calibration known from elsewhere.
        reference_name: What that one is called.
        intrinsics: Focal length for OpenCV's form; else the estimated one, else a nominal one.
        options: How exactly other tools' formats hold the lens; worked out when left out.
    """
    lens = calibration.lens
    focal = None if calibration.focal is None else FocalEstimate.from_dict(calibration.focal)
    chosen = intrinsics or choose_intrinsics(lens, estimate=focal)
    size = (lens.width, lens.height)
    headline, meaning = verdict(calibration)
    conversion = _opencv(calibration, chosen)
    figures = lens_figures(calibration)
    figures["difference"] = None if difference is None else difference_figure(difference, size)
    figures["free"] = None if calibration.free is None else free_figure(calibration.free, size)
    return _environment().get_template("report.html.j2").render(
        calibration=calibration,
        camera_name=camera_name,
        created=created,
        version=__version__,
        headline=headline,
        meaning=meaning,
        warnings=[(warned.message, ADVICE.get(warned.code, "")) for warned in calibration.warnings],
        family=FAMILY_TITLES[lens.family],
        parameters=parameter_rows(calibration),
        intrinsics=chosen,
        opencv=None if conversion is None else opencv_rows(conversion),
        opencv_error=None if conversion is None else conversion.error,
        ladder=ladder_rows(calibration),
        lines=worst_lines(calibration),
        more_images=max(len(calibration.images) - MOST_IMAGES, 0),
        focal=focal,
        free=calibration.free,
        difference=difference,
        reference_name=reference_name,
        exports=export_rows(
            overview(lens, chosen, calibration=calibration.as_dict()) if options is None else options
        ),
        pictures=pictures,
        figures={name: _trusted(svg) for name, svg in figures.items()},
        style=_trusted((TEMPLATES / "report.css").read_text(encoding="utf-8")),
    )  # fmt: skip


def _trusted(text: str | None) -> Markup | None:
    """Mark our own style sheet and plots, whose texts were escaped where they were made, as markup."""
    return None if text is None else Markup(text)  # noqa: S704


def _environment() -> Environment:
    environment = Environment(
        loader=FileSystemLoader(TEMPLATES), autoescape=True, undefined=StrictUndefined, trim_blocks=True,
        lstrip_blocks=True,
    )  # fmt: skip
    environment.filters |= {"px": pixels, "tiny_px": tiny_pixels}
    return environment


def _opencv(calibration: Calibration, intrinsics: Intrinsics) -> Conversion | None:
    """Return the lens in OpenCV's form; ``None`` where it has none."""
    try:
        return convert_opencv(frame_sample(calibration.lens, intrinsics))
    except CannotExport:
        return None
