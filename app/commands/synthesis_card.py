"""The card of a synthetic dataset: what is in it, what isn't, and how to make it again."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from app.synthesis.sampling import STEP
from app.synthesis.visibility import CLEAR_STEP, FAINT_STEP


@dataclass(eq=False)
class Tally:
    """What was drawn so far.

    Attributes:
        images: Number of images by camera.
        lenses: Lens by camera, as ``cameras.json`` holds it.
        counts: How many labels, ambiguous ones and distractors there are, by ``(what, kind)``.
    """

    images: Counter[str] = field(default_factory=Counter[str])
    lenses: dict[str, Mapping[str, Any]] = field(default_factory=dict[str, Mapping[str, Any]])
    counts: Counter[tuple[str, str]] = field(default_factory=Counter[tuple[str, str]])


def write_card(tally: Tally, *, seed: int, size: tuple[int, int], version: str) -> bytes:
    """Return the card as Markdown.

    Args:
        tally: Of all images.
        seed: That made them.
        size: Width and height, px.
        version: Of the program.
    """
    total = sum(tally.images.values())
    labels = {kind: count for (what, kind), count in tally.counts.items() if what == "labels"}
    ambiguous = sum(count for (what, _), count in tally.counts.items() if what == "ambiguous")
    distractors = {key: count for key, count in tally.counts.items() if key[0] not in ("labels", "ambiguous")}
    parts = [
        "# Synthetic streets",
        f"{total} images of {size[0]} x {size[1]} px by {len(tally.images)} cameras with "
        f"{sum(labels.values())} labels, {ambiguous} ambiguous lines and {sum(distractors.values())} distractors.",
        f"Made by ClearLines {version}: `clearlines synthesize --count {total} --seed {seed}`. "
        "The same seed gives the same images, up to rounding on other processors.",
        "## What is labelled",
        "The visible parts of edges that are straight in three dimensions: cut where something stands in front of "
        "them and at the border of the frame, bent as the lens bends them, a point about every "
        f"{STEP:g} px, at least 20 px long. An edge is clearly visible where the grey changes by {CLEAR_STEP:g} of "
        f"255 levels or more before noise. One whose step is {FAINT_STEP:g} or more, but clear along less than half "
        "of it, is ambiguous: to be scored neither way.",
        "Fragments of one edge share a number in `lines/NAME.json`, in the order of the label files. The same file "
        "holds the distractors: edges that are seen and are no labels, each with its kind and with the reason that a "
        "reviewer would give.",
        _table(("edges of", "labels"), Counter(labels).most_common()),
        "## Distractors",
        _table(
            ("reason", "kind", "count"),
            [(reason, kind, count) for (reason, kind), count in sorted(distractors.items())],
        ),
        "## Lenses",
        "OpenCV's model: focal length in px, distortion k1, k2, p1, p2, k3 in the distort direction.",
        _table(
            ("camera", "images", "focal length", "k1", "k2", "p1", "p2", "k3"),
            [
                (name, tally.images[name], f"{lens['K'][0][0]:.1f}", *(f"{value:.5f}" for value in lens["D"]))
                for name, lens in tally.lenses.items()
            ],
        ),
        "## What is in it, and what isn't",
        "Street canyons, straight and bent, by day, in the evening, under clouds and at dusk: facades with windows, "
        "shops and roofs, poles, signs, wires, kerbs, markings, guard rails, trees, cars and people; shadows, haze, "
        "vignetting, motion blur, noise, sharpening and JPEG artefacts, of which each camera has its own share.",
        "Not in it: indoor scenes, rain, snow, night without lamps, reflections of the street in windows or puddles, "
        "rolling shutter, defocus, lettering to be read. Shadows have hard edges; walls are flat. Patterns of bricks, "
        "plaster, stone, leaves and clouds are neither labels nor listed as distractors.",
        "## Licence",
        "CC0 1.0: no photo, no texture and no model of anybody else's is in the images.",
    ]
    return ("\n\n".join(parts) + "\n").encode()


def _table(columns: Sequence[str], rows: Sequence[Sequence[object]]) -> str:
    if not rows:
        return "None."
    lines = [columns, ["---"] * len(columns), *rows]
    return "\n".join("| " + " | ".join(str(cell) for cell in line) + " |" for line in lines)
