"""The algorithms: an image in, segments and a lens out. No web, no database, no files.

Coordinates are px, x right, y down, with the pixel's centre at integers.
"""

from app.vision.brown import Brown
from app.vision.distortion import DistortionEstimate, TrustedSegments, estimate_distortion
from app.vision.history import SegmentHistory, detect_with_history
from app.vision.parameters import DetectionParameters
from app.vision.pipeline import detect
from app.vision.prelabel import (
    Detection,
    PrelabelledCamera,
    PrelabelledImage,
    PrelabelResult,
    assemble,
    detect_for_prelabel,
    prelabel,
)
from app.vision.segments import Segments
from app.vision.straightness import judge_straightness

__all__ = [
    "Brown",
    "Detection",
    "DetectionParameters",
    "DistortionEstimate",
    "PrelabelResult",
    "PrelabelledCamera",
    "PrelabelledImage",
    "SegmentHistory",
    "Segments",
    "TrustedSegments",
    "assemble",
    "detect",
    "detect_for_prelabel",
    "detect_with_history",
    "estimate_distortion",
    "judge_straightness",
    "prelabel",
]
