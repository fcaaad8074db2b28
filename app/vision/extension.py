"""Following an arc beyond its ends where the edge goes on too weakly to have been chained."""

from __future__ import annotations

from app.vision.edges import EdgeMap
from app.vision.merging import Merging
from app.vision.native.library import kernels
from app.vision.native.records import address


def extend(merging: Merging, edges: EdgeMap) -> None:
    """Move both ends of the arcs alive outwards over measured points, in their records.

    The walk goes on along the arc until too many steps in a row have no point; it may be as long as the arc itself, and
    70 % of its steps must have a point. Where the points then turn into a corner that blur has rounded off, the end
    goes two steps on. Arcs shorter than 25 px stay as they are, and so does every fit.

    Args:
        merging: The newest state.
        edges: Of the image, weak points included.
    """
    kernels().cl_extend(edges.scene, address(merging.records), merging.count)
