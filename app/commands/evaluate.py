"""``clearlines evaluate``: score predictions against labels, folder against folder, with pictures; needs no server."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from app.commands.pictures import find_images, write_picture
from app.commands.segment_files import Read, SegmentFiles, one_error, open_segment_files
from app.commands.whole_files import json_bytes, write_whole
from app.errors import ClearLinesError, InvalidInput
from app.evaluation import GroundTruth, ground_truth
from app.evaluation.official_v1 import PROTOCOL, ImageScore, score_image
from app.evaluation.summary import Evaluation, image_content, summary_content, summary_text
from app.vision.segments import Segments

DEFAULT_PICTURES = Path("evaluation/visualization")

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class EvaluatedFolder:
    """What was found and where it was written.

    Attributes:
        evaluation: The scores.
        folder: Where ``summary.txt``, ``summary.json`` and ``individual_results/`` are.
        pictures: Where the pictures are; ``None`` if no images were given.
        without_picture: Names of scored images that the image folder doesn't hold.
        picture_errors: Why images could not be drawn on; their scores stand.
    """

    evaluation: Evaluation
    folder: Path
    pictures: Path | None = None
    without_picture: tuple[str, ...] = ()
    picture_errors: tuple[ClearLinesError, ...] = ()


@dataclass(frozen=True)
class _Task:
    """Everything that the score of an image is read from."""

    truth: SegmentFiles
    predictions: SegmentFiles
    min_length: float

    def read(self, name: str) -> tuple[GroundTruth, Segments, NDArray[np.int64]]:
        """Return the truth of an image, the predictions that count, and the place of each in its file."""
        truth = _truth(name, self.truth, self.min_length)
        predictions = _read(self.predictions.files, name)
        kept = np.flatnonzero(predictions.lengths() >= self.min_length)
        return truth, predictions.select(kept), kept


def evaluate(
    labels: Path,
    predictions: Path,
    *,
    images: Path | None = None,
    pictures: Path = DEFAULT_PICTURES,
    protocol: str = PROTOCOL,
    min_length: float = 0.0,
    progress: Progress | None = None,
) -> EvaluatedFolder:
    """Score predictions against labels, image by image, paired by name.

    Nothing is written unless all label and prediction files can be read; each file appears whole, the summary last.
    An image without a prediction file counts as one without predictions.

    Args:
        labels: Folder of label files, or one file for all images.
        predictions: Folder of prediction files, or one file for all images.
        images: Folder of images to draw on; it may hold more than those with labels.
        pictures: Where the pictures go. ``summary.txt``, ``summary.json`` and ``individual_results/`` go into the
            folder that this one lies in.
        protocol: How to score; ``official-v1``.
        min_length: Predictions of less arc length are left out, labels of less are ignored, px.
        progress: Called with steps done and steps in total; a step is an image scored or drawn.

    Raises:
        NotFound: If a folder doesn't exist.
        InvalidInput: If there are no labels, two files are for one image, or the protocol or length makes no sense.
        InvalidFile: If files can't be read; all of them are named.
        TooLarge: If a file is over the limits.
        OSError: If the results can't be written.
    """
    _check(protocol, min_length)
    found_images = {} if images is None else find_images(images)
    task = _Task(
        open_segment_files(labels, "ground truth", found_images),
        open_segment_files(predictions, "predictions", found_images),
        min_length,
    )
    names = sorted({*task.truth.files, *task.truth.ambiguous})
    if not names:
        raise InvalidInput(
            "there are no label files",
            where=str(labels),
            expected="NAME.npy, .npz or .json, or NAME_edge_segments_filtered.npy, subfolders included",
        )
    drawn = [name for name in names if name in found_images]
    steps = _Steps(len(names) + len(drawn), progress)

    evaluation = Evaluation(
        names=tuple(names),
        scores=_score_all(task, names, steps),
        missing=tuple(name for name in names if name not in task.predictions.files),
        extra=tuple(sorted(set(task.predictions.files) - set(names))),
        min_length=min_length,
    )
    folder = pictures.parent
    picture_errors: list[ClearLinesError] = []
    for name, score in zip(names, evaluation.scores, strict=True):
        truth, chosen, kept = task.read(name)
        content = json_bytes(image_content(name, score, kept.tolist()))
        write_whole(folder / "individual_results" / f"{name}.json", content)
        if name in found_images:
            try:
                write_picture(found_images[name], pictures / f"{name}.png", truth.segments, chosen, score)
            except ClearLinesError as error:
                picture_errors.append(error)
            steps.done()
    write_whole(folder / "summary.json", json_bytes(summary_content(evaluation)))
    write_whole(folder / "summary.txt", summary_text(evaluation).encode())
    without_picture = () if images is None else tuple(name for name in names if name not in found_images)
    return EvaluatedFolder(
        evaluation, folder, None if images is None else pictures, without_picture, tuple(picture_errors)
    )


class _Steps:
    """Counts steps for whoever shows the progress."""

    def __init__(self, total: int, progress: Progress | None) -> None:
        self.count, self.total, self.progress = 0, total, progress

    def done(self) -> None:
        self.count += 1
        if self.progress:
            self.progress(self.count, self.total)


def _check(protocol: str, min_length: float) -> None:
    if protocol != PROTOCOL:
        raise InvalidInput(f"there is no protocol {protocol!r}", where="protocol", expected=PROTOCOL)
    if not (math.isfinite(min_length) and min_length >= 0):
        raise InvalidInput(f"{min_length} is no length", where="minimum length", expected="0 or more px")


def _score_all(task: _Task, names: list[str], steps: _Steps) -> tuple[ImageScore, ...]:
    scores: list[ImageScore] = []
    errors: list[ClearLinesError] = []
    for name in names:
        try:
            truth, predictions, _ = task.read(name)
            scores.append(score_image(truth, predictions))
        except ClearLinesError as error:
            errors.append(error)
        steps.done()
    if errors:
        raise one_error(errors)
    return tuple(scores)


def _truth(name: str, files: SegmentFiles, min_length: float) -> GroundTruth:
    """Return the labels of an image; of a file with verdicts those kept, the ambiguous ones being ignored."""
    ambiguous = _read(files.ambiguous, name)
    if name not in files.files:
        return ground_truth(Segments.empty(), ambiguous, min_length)
    labelled = files.files[name]()
    if labelled.verdicts is None:
        return ground_truth(labelled.segments, ambiguous, min_length)
    unsure = labelled.with_verdict("ambiguous").segments
    both = Segments.from_list([*unsure, *ambiguous])
    return ground_truth(labelled.with_verdict("keep").segments, both, min_length)


def _read(files: Mapping[str, Read], name: str) -> Segments:
    return files[name]().segments if name in files else Segments.empty()
