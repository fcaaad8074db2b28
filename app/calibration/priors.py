"""What is known of a lens before any line is looked at: normal laws around no distortion.

The standard deviations are those of lenses in use, for coefficients in half diagonals. Within them lies nearly every
camera lens short of a fisheye; they decide only what lines leave open.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import product

import numpy as np
from numpy.typing import NDArray

from app.calibration.lens import FAMILIES, Family

Array = NDArray[np.float64]

PRIOR_SD: Mapping[Family, Mapping[str, float]] = {
    "brown": {"k1": 0.3, "k2": 0.1, "k3": 0.05, "p1": 0.002, "p2": 0.002, "cx": 0.025, "cy": 0.025},
    "opencv": {"k1": 0.3, "k2": 0.1, "k3": 0.05, "p1": 0.002, "p2": 0.002, "cx": 0.025, "cy": 0.025},
    "division": {"k1": 0.3, "k2": 0.1, "k3": 0.05, "cx": 0.025, "cy": 0.025},
}


BEYOND_SD = 0.03
"""Of the coefficient of r^8, which stands for what no family follows."""
PLAIN: tuple[Mapping[str, float], ...] = (
    {"k2": 0.15, "k3": 0.1, "beyond": 0.1},
    {"cx": 0.25, "cy": 0.25},
    {"p1": 0.15, "p2": 0.15},
)
"""Most lenses are plainer than the widest: each of these groups is taken for as large as its prior says or for this
share of it (spike and slab; George and McCulloch 1993)."""


def prior_sd(family: Family) -> Array:
    """Return the prior standard deviation of each parameter of a family, in the order of its names."""
    return np.array([PRIOR_SD[family][name] for name in FAMILIES[family].names])


def prior_kinds(family: Family) -> Array:
    """Return what the standard deviations may be, of all parameters and of the one beyond, float64 ``(K, P + 1)``."""
    names = (*FAMILIES[family].names, "beyond")
    sd = np.append(prior_sd(family), BEYOND_SD)
    groups = [group for group in PLAIN if set(group) & set(names)]
    kinds: list[Array] = []
    for plain in product((False, True), repeat=len(groups)):
        share = np.ones(len(names))
        for group in (group for group, chosen in zip(groups, plain, strict=True) if chosen):
            share *= [group.get(name, 1.0) for name in names]
        kinds.append(sd * share)
    return np.stack(kinds)
