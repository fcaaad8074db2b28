"""What the segments of a camera say about k1, structure by structure.

Segments aren't independent witnesses. The rim of a bonnet, a kerb or a roof is found as several long, smooth pieces
that all bend alike, and together they would outvote everything else in an image. So the evidence is taken in
structures: the lying segments at about one height of the frame, the upright ones at about one column. Each structure
may bend by its own, as if seen through a lens of k1 + b (a random effect):

    p(k1 | all) ~ p(k1) prod_g integral p(segments of g | k1 + b) q(b) db,
    q(b) = (1 - STRAY) N(b; 0, sd^2) + STRAY uniform

A structure by itself therefore never tells k1 better than its sd, nor by more than the odds of its being astray,
however many segments it has; to be sure takes several that agree. Edges that gravity made upright bend less by their
own than lying ones.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from app.vision.bins import BinnedSegments
from app.vision.persistence import FEWEST_IMAGES

Array = NDArray[np.float64]


class LensKind(NamedTuple):
    """A kind of lenses, before any segment is looked at.

    Attributes:
        mean: Of k1.
        sd: Standard deviation of k1.
        share: Of all lenses.
    """

    mean: float
    sd: float
    share: float


SCAN = np.linspace(-0.25, 0.5, 76)
"""k1 of all plausible lenses."""
KINDS = (LensKind(0.0, 0.05, 0.7), LensKind(0.18, 0.07, 0.3))
"""Most lenses bend little, in either sense; wide ones are barrels, those of known cameras of 0.11 to 0.31. One law
around 0 for both would draw every wide lens towards 0, by the square of the ratio of what isn't known of k1 to the
law's width: by a tenth of k1 where there is one street image."""
BANDS = 4
"""Heights, and likewise columns, that a frame is divided into."""
UPRIGHT_SD, LYING_SD = 0.03, 0.08
"""Standard deviation of the k1 that structures add by their own, by the likelihood of images under known lenses."""
STRAY = 0.1
"""Share of structures that tell nothing of the lens."""
TEMPERATURE = 2.0
"""By how much the evidence within a structure is divided: most edges come in pairs, the two sides of one bar."""


@dataclass(frozen=True, eq=False)
class K1Posterior:
    """What is known of k1 where it is the only parameter and the centre is that of the image.

    Attributes:
        probability: float64 ``(76,)`` over `SCAN`, adding up to 1.
        mean: The estimate of least expected squared error.
        sd: Standard deviation, which a second basin widens.
    """

    probability: Array
    mean: float
    sd: float


def structures(binned: BinnedSegments) -> NDArray[np.int64]:
    """Return the structure of each segment, int64 ``(S,)``.

    The last three bits are 0 to 3 for lying ones from top to bottom, 4 to 7 for upright ones from left to right; the
    others tell images apart. Over so few images that edges of the vehicle couldn't be told by their staying in place,
    what lies at one place is one structure in all of them.
    """
    across = np.where(binned.vertical, binned.middle[:, 0], binned.middle[:, 1])
    band = np.clip((across * BANDS).astype(np.int64), 0, BANDS - 1)
    image = binned.image if len(np.unique(binned.image)) >= FEWEST_IMAGES else np.zeros_like(binned.image)
    return band + BANDS * binned.vertical + 2 * BANDS * image


def structure_sd(structure: NDArray[np.int64]) -> Array:
    """Return the standard deviation of the k1 that structures add by their own, float64, of the shape given."""
    return np.where(structure % (2 * BANDS) < BANDS, LYING_SD, UPRIGHT_SD)


def sum_structures(values: Array, structure: NDArray[np.int64]) -> tuple[NDArray[np.int64], Array]:
    """Add up values ``(S, ...)`` by structure; return the structures ``(G,)`` and their sums ``(G, ...)``."""
    order = np.argsort(structure, kind="stable")
    found, first = np.unique(structure[order], return_index=True)
    return found, np.add.reduceat(values[order], first, axis=0)


def k1_posterior(losses: Array, structure: NDArray[np.int64]) -> K1Posterior:
    """Combine the evidence of all structures.

    Args:
        losses: float64 ``(76, S)``, negative log likelihood of each segment at each k1 of `SCAN`.
        structure: int64 ``(S,)`` from `structures`.
    """
    evidence = np.log(k1_prior())
    found, loss = sum_structures(losses.T / TEMPERATURE, structure)
    likelihood = np.exp(loss.min(1, keepdims=True) - loss)
    for sd in (LYING_SD, UPRIGHT_SD):
        evidence += np.log(likelihood[structure_sd(found) == sd] @ _own_bend(sd).T).sum(0)
    probability = np.exp(evidence - evidence.max())
    probability /= probability.sum()
    mean = float(probability @ SCAN)
    return K1Posterior(probability, mean, float(np.sqrt(probability @ (SCAN - mean) ** 2)))


def k1_prior() -> Array:
    """Return what is known of k1 before any segment is looked at, float64 ``(76,)`` over `SCAN`, adding up to 1."""
    density = sum(kind.share / kind.sd * np.exp(-0.5 * ((SCAN - kind.mean) / kind.sd) ** 2) for kind in KINDS)
    return np.asarray(density / np.sum(density), np.float64)


def _own_bend(sd: float) -> Array:
    """Return q(b) for b from each k1 of the scan (rows) to each (columns), float64 ``(76, 76)``."""
    near = np.exp(-0.5 * ((SCAN[:, None] - SCAN) / sd) ** 2)
    near /= near.sum(1, keepdims=True)
    return (1 - STRAY) * near + STRAY / len(SCAN)
