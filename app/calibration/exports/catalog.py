"""Every format a lens can be written in, by key."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from app.calibration.exports.colmap import convert_colmap, write_colmap
from app.calibration.exports.conversion import Conversion
from app.calibration.exports.draft import Draft
from app.calibration.exports.frame_sample import FrameSample
from app.calibration.exports.kalibr import convert_kalibr, write_kalibr
from app.calibration.exports.lensfun import write_lensfun
from app.calibration.exports.lensfun_fit import convert_lensfun
from app.calibration.exports.lossless import write_lossless
from app.calibration.exports.map_conversion import convert_remap, convert_stmap
from app.calibration.exports.matlab import convert_matlab, write_matlab
from app.calibration.exports.mrcal import convert_mrcal, write_mrcal
from app.calibration.exports.names import file_stem
from app.calibration.exports.opencv_storage import convert_opencv, write_opencv_json, write_opencv_yaml
from app.calibration.exports.remap import write_remap
from app.calibration.exports.ros import convert_ros, write_ros
from app.calibration.exports.stmap import write_stmap


@dataclass(frozen=True)
class ExportFormat:
    """A format.

    Attributes:
        name: Its key.
        title: For menus.
        suffix: What the camera's name is followed by in a file's name.
        media_type: Of the file.
        convert: Fits the format's lens to ours; None if the format holds any lens as it is.
        write: Writes what was fitted.
    """

    name: str
    title: str
    suffix: str
    media_type: str
    convert: Callable[[FrameSample], Conversion] | None
    write: Callable[[Draft], bytes]

    def file_name(self, camera_name: str) -> str:
        """Return the name of a camera's file: ASCII, without separators."""
        return file_stem(camera_name) + self.suffix


YAML, JSON, TEXT = "application/yaml", "application/json", "text/plain; charset=utf-8"
ALL = (
    ExportFormat("opencv-yaml", "OpenCV YAML", "_opencv.yaml", YAML, convert_opencv, write_opencv_yaml),
    ExportFormat("opencv-json", "OpenCV JSON", "_opencv.json", JSON, convert_opencv, write_opencv_json),
    ExportFormat("ros", "ROS camera_info", "_camera_info.yaml", YAML, convert_ros, write_ros),
    ExportFormat("kalibr", "Kalibr camchain", "_camchain.yaml", YAML, convert_kalibr, write_kalibr),
    ExportFormat("colmap", "COLMAP cameras.txt", "_cameras.txt", TEXT, convert_colmap, write_colmap),
    ExportFormat("matlab", "MATLAB", "_matlab.mat", "application/octet-stream", convert_matlab, write_matlab),
    ExportFormat("lensfun", "Lensfun XML", "_lensfun.xml", "application/xml", convert_lensfun, write_lensfun),
    ExportFormat("mrcal", "mrcal", ".cameramodel", TEXT, convert_mrcal, write_mrcal),
    ExportFormat("stmap", "STMap", "_stmap.zip", "application/zip", convert_stmap, write_stmap),
    ExportFormat("remap", "Maps for cv2.remap", "_remap.npz", "application/octet-stream", convert_remap, write_remap),
    ExportFormat("clearlines", "ClearLines, lossless", "_clearlines.json", JSON, None, write_lossless),
)
"""In the order of menus."""

FORMATS: Mapping[str, ExportFormat] = MappingProxyType({each.name: each for each in ALL})
