"""The pipeline on real photos: detection against OpenCV's LSD in the same run, and the joint lens of 15 frames.

python benchmarks/pipeline.py [--json] [--york DIR] [--kitti DIR]
"""

from __future__ import annotations

import time
from collections.abc import Callable
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from shared.reporting import Target, arguments, finish, show_table

from app.evaluation.line_iou import line_iou_matrix
from app.evaluation.matching import match_one_to_one
from app.formats.inert_npy import read_label_npy
from app.formats.reference_camera import ALL, read_cameras
from app.images import decode_gray
from app.vision import DetectionParameters, Segments, assemble, detect, detect_for_prelabel
from app.vision.conversion import OpenCVLens
from app.vision.division import Division
from app.vision.field import Lens, field_error
from app.vision.intensity import to_eight_bit
from app.vision.lens_fields import brown_from_dict

MIN_LENGTH = 50.0
Detector = Callable[[NDArray[np.uint8]], Segments]


def opencv_lsd(gray: NDArray[np.uint8]) -> Segments:
    lines = cv2.createLineSegmentDetector().detect(gray)[0]
    ends = np.zeros((0, 4)) if lines is None else lines.reshape(-1, 4)
    return Segments.from_list([line.reshape(2, 2) for line in ends])


def ours(gray: NDArray[np.uint8]) -> Segments:
    return detect(gray, DetectionParameters(min_length=MIN_LENGTH))


def score_detector(detector: Detector, folder: Path) -> dict[str, float]:
    """One-to-one by line IoU >= 0.5 over all photos; lines of 50 px and more."""
    hits = predictions = labels = 0
    seconds: list[float] = []
    for path in sorted((folder / "images").iterdir()):
        gray = to_eight_bit(decode_gray(path.read_bytes()))
        start = time.perf_counter()
        found = detector(gray)
        seconds.append(time.perf_counter() - start)
        truth = read_label_npy((folder / "labels" / f"{path.stem}_edge_segments_filtered.npy").read_bytes())
        truth = truth.select(truth.lengths() >= MIN_LENGTH)
        found = found.select(found.lengths() >= MIN_LENGTH)
        hits += len(match_one_to_one(line_iou_matrix(found, truth), 0.5).row)
        predictions += len(found)
        labels += len(truth)
    return {
        "precision": hits / max(predictions, 1),
        "recall": hits / max(labels, 1),
        "milliseconds": float(np.median(seconds) * 1000),
    }


def joint_lens(folder: Path) -> dict[str, float]:
    """Field error, px RMS, of the lens read off all frames, against the published calibration; and the time."""
    reference = read_cameras((folder / "camera.json").read_bytes())[ALL]
    start = time.perf_counter()
    parameters = DetectionParameters()
    frames = [decode_gray(path.read_bytes()) for path in sorted((folder / "images").iterdir())]
    result = assemble([detect_for_prelabel(frame, parameters) for frame in frames])
    seconds = time.perf_counter() - start
    estimate = result.cameras[0].estimate
    truth = OpenCVLens(reference.matrix, reference.distortion)

    def error(lens: Lens) -> float:
        return field_error(truth, lens, reference.width, reference.height).rms

    return {
        "kitti_field_error_px": error(estimate.brown),
        "kitti_field_error_of_msac_px": error(brown_from_dict(estimate.msac or {})),
        "kitti_field_error_of_identity_px": error(Division(reference.width, reference.height)),
        "kitti_uncertainty_px": estimate.uncertainty.pred,
        "kitti_accepted": float(estimate.accepted),
        "kitti_seconds": seconds,
    }


def main() -> None:
    options = arguments(str(__doc__), "york", "kitti")
    cv2.setNumThreads(1)
    figures: dict[str, float | None] = {}
    targets: list[Target] = []
    if options.york.is_dir():
        detectors: dict[str, Detector] = {"ClearLines": ours, "OpenCV LSD": opencv_lsd}
        scores = {name: score_detector(detector, options.york) for name, detector in detectors.items()}
        for name, prefix in (("ClearLines", "york"), ("OpenCV LSD", "york_lsd")):
            figures |= {f"{prefix}_{key}": value for key, value in scores[name].items()}
        rows = [
            [name, f"{score['precision']:.3f}", f"{score['recall']:.3f}", f"{score['milliseconds']:.1f}"]
            for name, score in scores.items()
        ]
        show_table("Detection, one thread", ["detector", "precision", "recall", "ms / image (median)"], rows)
        targets += [Target("york_recall", 0.638, at_most=False), Target("york_precision", 0.2, at_most=False)]
    if options.kitti.is_dir():
        lens = joint_lens(options.kitti)
        figures |= lens
        show_table(
            "Lens of 15 frames jointly",
            ["estimate", "field error, px RMS"],
            [
                ["no correction", f"{lens['kitti_field_error_of_identity_px']:.2f}"],
                ["MSAC, as in the paper", f"{lens['kitti_field_error_of_msac_px']:.2f}"],
                ["ClearLines", f"{lens['kitti_field_error_px']:.2f}"],
            ],
        )
        targets += [Target("kitti_field_error_px", 1.5), Target("kitti_seconds", 30.0)]
    if not figures:
        print(f"no data: neither {options.york} nor {options.kitti} is there")
    finish(figures, targets, as_json=options.json)


if __name__ == "__main__":
    main()
