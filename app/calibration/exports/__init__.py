"""A camera's lens as files that other tools read, each refitted over the frame and with its error told."""

from app.calibration.exports.catalog import FORMATS, ExportFormat
from app.calibration.exports.export import LIMIT, Exported, ExportOption, export_lens, overview
from app.calibration.exports.frame_sample import ConversionError
from app.calibration.exports.intrinsics import Intrinsics, choose_intrinsics, nominal_intrinsics

__all__ = [
    "FORMATS",
    "LIMIT",
    "ConversionError",
    "ExportFormat",
    "ExportOption",
    "Exported",
    "Intrinsics",
    "choose_intrinsics",
    "export_lens",
    "nominal_intrinsics",
    "overview",
]
