"""Pre-labelling of 15 real frames of one camera: detection, and the lens read off all candidates together.

python benchmarks/pipeline.py [--json] [--kitti DIR]
"""

from __future__ import annotations

import time
from pathlib import Path

import cv2
from shared.reporting import Target, arguments, finish, show_table

from app.formats.reference_camera import ALL, read_cameras
from app.images import decode_gray
from app.vision import DetectionParameters, assemble, detect_for_prelabel
from app.vision.conversion import OpenCVLens
from app.vision.division import Division
from app.vision.field import Lens, field_error
from app.vision.lens_fields import brown_from_dict


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
    options = arguments(str(__doc__), "kitti")
    cv2.setNumThreads(1)
    if not options.kitti.is_dir():
        print(f"no data: {options.kitti} is not there")
        finish({}, [], as_json=options.json)
        return
    lens = joint_lens(options.kitti)
    show_table(
        "Lens of 15 frames jointly",
        ["estimate", "field error, px RMS"],
        [
            ["no correction", f"{lens['kitti_field_error_of_identity_px']:.2f}"],
            ["MSAC, as in the paper", f"{lens['kitti_field_error_of_msac_px']:.2f}"],
            ["ClearLines", f"{lens['kitti_field_error_px']:.2f}"],
        ],
    )
    finish(lens, [Target("kitti_field_error_px", 1.5), Target("kitti_seconds", 30.0)], as_json=options.json)


if __name__ == "__main__":
    main()
