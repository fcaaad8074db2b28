"""Detectors that run in the benchmark's own process, and what a detector found in a set of images."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from app.vision import DetectionParameters, Segments, detect
from app.vision.parameters import OperatingPoint

Detector = Callable[[NDArray[np.uint8]], Segments]


@dataclass(frozen=True, eq=False)
class Found:
    """What a detector found in each of N images.

    Attributes:
        segments: N times the segments, px.
        seconds: float64 ``(N,)``, the time of each image.
    """

    segments: tuple[Segments, ...]
    seconds: NDArray[np.float64]

    @property
    def milliseconds(self) -> float:
        """Median time of an image, ms."""
        return float(np.median(self.seconds) * 1000)


def clearlines(min_length: float, operating_point: OperatingPoint = "balanced") -> Detector:
    """Return our detector at an operating point."""
    parameters = DetectionParameters(min_length=min_length, operating_point=operating_point)
    return lambda gray: detect(gray, parameters)


def opencv_lsd() -> Detector:
    """Return OpenCV's LSD (von Gioi et al., IPOL 2012) with its default settings."""
    detector = cv2.createLineSegmentDetector()

    def lsd(gray: NDArray[np.uint8]) -> Segments:
        lines = detector.detect(gray)[0]
        return Segments.from_list([] if lines is None else list(lines.reshape(-1, 2, 2)))

    return lsd


def take_turns(detectors: Mapping[str, Detector], images: Sequence[NDArray[np.uint8]]) -> dict[str, Found]:
    """Run each detector once on each image, in this process; all have had an image before the clock runs.

    They take turns, so that whatever else the machine does slows all of them.
    """
    segments: dict[str, list[Segments]] = {name: [] for name in detectors}
    seconds: dict[str, list[float]] = {name: [] for name in detectors}
    for detector in detectors.values():
        detector(images[0])
    for image in images:
        for name, detector in detectors.items():
            start = time.perf_counter()
            segments[name].append(detector(image))
            seconds[name].append(time.perf_counter() - start)
    return {name: Found(tuple(segments[name]), np.array(seconds[name])) for name in detectors}
