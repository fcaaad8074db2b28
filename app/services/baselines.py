"""Baseline rows of a board: detectors of our own run over a split's images and queued like any submission."""

from __future__ import annotations

from collections.abc import Callable
from datetime import datetime

import cv2
from sqlalchemy import select

from app import __version__
from app.db.models import Image, SplitImage
from app.db.session import Database
from app.images.decode import decode_gray
from app.services.baseline_detectors import detect_candidates, detect_lsd
from app.services.own_submissions import OwnMethod, queue_own_submission
from app.services.splits import current_version, get_split
from app.services.stored_candidates import stored_candidates
from app.storage import BlobStore
from app.vision.segments import Segments

Progress = Callable[[int, int], None]


PIPELINE = OwnMethod(
    "Pre-labelling pipeline",
    f"ClearLines {__version__}",
    "All candidates that annotators are shown, before the straightness filter and before any decision.",
)
LSD = OwnMethod(
    "OpenCV LSD",
    f"OpenCV {cv2.__version__}",
    "OpenCV's line segment detector with its defaults, segments of at least the split's minimum length.",
    "https://docs.opencv.org/4.x/db/d73/classcv_1_1LineSegmentDetector.html",
    "https://doi.org/10.5201/ipol.2012.gjmr-lsd",
)
BASELINES = (PIPELINE, LSD)


def add_baselines(
    database: Database,
    blobs: BlobStore,
    slug: str,
    now: datetime,
    *,
    max_pixels: int,
    progress: Progress | None = None,
) -> list[int]:
    """Run the baselines over the newest version of a split and queue what they find; a dispatcher scores it.

    What is on the board already, with the same segments, isn't handed in again.

    Args:
        database: Where the rows are.
        blobs: Where the images are.
        slug: Of the split.
        now: When.
        max_pixels: Greatest number of pixels that is decoded.
        progress: Called with the images done and their total.

    Returns:
        Ids of the submissions, one per baseline, in the order of ``BASELINES``.

    Raises:
        NotFound: When there is no such split, or an image's file is gone.
        InvalidImage: When an image can't be decoded.
    """
    with database.read() as session:
        split = get_split(session, slug)
        version = current_version(session, split)
        query = select(SplitImage).where(SplitImage.version_id == version.id).order_by(SplitImage.ordinal)
        images = list(session.scalars(query))
    found: dict[str, dict[str, Segments]] = {baseline.name: {} for baseline in BASELINES}
    for place, image in enumerate(images):
        with database.read() as session:
            held = session.get(Image, image.image_id) if image.image_id is not None else None
            unchanged = held is not None and held.sha256 == image.image_sha256
            candidates = stored_candidates(session, held) if held is not None and unchanged else None
        gray = decode_gray(blobs.read(image.image_sha256), max_pixels=max_pixels)
        stored = detect_candidates(gray, split.min_length) if candidates is None else candidates
        found[PIPELINE.name][image.name] = stored
        found[LSD.name][image.name] = detect_lsd(gray, split.min_length)
        if progress is not None:
            progress(place + 1, len(images))
    return [
        queue_own_submission(database, blobs, version.id, baseline, found[baseline.name], now) for baseline in BASELINES
    ]
