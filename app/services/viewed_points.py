"""The points of an image's candidates as they lie in the view without distortion."""

from __future__ import annotations

import struct

import numpy as np
from sqlalchemy.orm import Session

from app.services.image_views import viewed_image
from app.services.images import get_image
from app.services.labelling import points_of_image

HEADER = struct.Struct("<4sIII")


def undistorted_points(session: Session, image_id: int) -> bytes:
    """Return what ``points_of_image`` does, with each point where the view ``undistorted`` shows it.

    Raises:
        NotFound: When there is no such image, or it is deleted.
        Conflict: When the lens isn't known.
    """
    view = viewed_image(session, get_image(session, image_id), "undistorted").undistorted
    stored = points_of_image(session, image_id)
    _, _, segments, points = HEADER.unpack_from(stored)
    start = HEADER.size + 4 * (2 * segments + 1)
    measured = np.frombuffer(stored, "<f4", 2 * points, start).reshape(-1, 2)
    seen = measured if view is None or not points else view.project(measured)
    return stored[:start] + seen.astype("<f4").tobytes()
