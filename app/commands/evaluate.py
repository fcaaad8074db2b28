"""``clearlines evaluate``: score predictions against labels, folder against folder, with pictures; needs no server."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from app.commands.evaluated_images import describe_images
from app.commands.evaluated_labels import read_labels, read_plain
from app.commands.pictures import find_images, write_picture
from app.commands.segment_files import SegmentFiles, one_error, open_segment_files
from app.commands.whole_files import json_bytes, write_whole
from app.errors import ClearLinesError, InvalidInput
from app.evaluation import protocol_named
from app.evaluation.bootstrap import DRAWS
from app.evaluation.official_v1 import PROTOCOL
from app.evaluation.protocols import Score
from app.evaluation.submission_scoring import (
    ImageRecord,
    ScoredImage,
    SplitImageInfo,
    score_cameras,
    score_image,
    score_totals,
)
from app.evaluation.summary import Evaluation, summary_text
from app.evaluation.summary_json import image_content, summary_content
from app.evaluation.table_one import SHOWN, TableRow, table_rows

DEFAULT_PICTURES = Path("evaluation/visualization")

MOST_DRAWS = 100_000

Progress = Callable[[int, int], None]


@dataclass(frozen=True)
class EvaluatedFolder:
    """What was found and where it was written.

    Attributes:
        evaluation: The scores.
        table: The same by source, in the form of the paper's Table I.
        folder: Where ``summary.txt``, ``summary.json`` and ``individual_results/`` are.
        pictures: Where the pictures are; ``None`` if no images were given.
        without_picture: Names of scored images that the image folder doesn't hold.
        picture_errors: Why images could not be drawn on; their scores stand.
    """

    evaluation: Evaluation
    table: tuple[TableRow, ...]
    folder: Path
    pictures: Path | None = None
    without_picture: tuple[str, ...] = ()
    picture_errors: tuple[ClearLinesError, ...] = ()


@dataclass(frozen=True)
class Scoring:
    """How to score.

    Attributes:
        protocol: The one that the result is stated under, pictures and single images included.
        min_length: Predictions of less arc length are left out, labels of less are ignored, px.
        draws: Draws of the bootstrap that intervals are taken from.
        seed: Of the draws.

    Raises:
        InvalidInput: If there is no such protocol, or a number makes no sense.
    """

    protocol: str = PROTOCOL
    min_length: float = 0.0
    draws: int = DRAWS
    seed: int = 0

    def __post_init__(self) -> None:
        protocol_named(self.protocol)
        if not (math.isfinite(self.min_length) and self.min_length >= 0):
            raise InvalidInput(f"{self.min_length} is no length", where="minimum length", expected="0 or more px")
        if not 1 <= self.draws <= MOST_DRAWS:
            raise InvalidInput(f"{self.draws} draws make no interval", where="draws", expected=f"1 to {MOST_DRAWS}")


@dataclass(frozen=True)
class _Task:
    """Everything that the score of an image is read from."""

    truth: SegmentFiles
    predictions: SegmentFiles
    min_length: float

    def read(self, info: SplitImageInfo) -> ScoredImage:
        """Return truth and predictions of an image."""
        truth, rejected = read_labels(self.truth, info.name, self.min_length)
        return ScoredImage(info, truth, read_plain(self.predictions.files, info.name), rejected)


def evaluate(
    labels: Path,
    predictions: Path,
    *,
    images: Path | None = None,
    pictures: Path = DEFAULT_PICTURES,
    scoring: Scoring = Scoring(),
    progress: Progress | None = None,
) -> EvaluatedFolder:
    """Score predictions against labels, image by image, paired by name.

    Nothing is written unless all label and prediction files can be read; each file appears whole, the summary last.
    An image without a prediction file counts as one without predictions. All protocols are scored at once; one of them
    is what the result is stated under.

    Args:
        labels: Folder of label files, or one file for all images.
        predictions: Folder of prediction files, or one file for all images.
        images: Folder of images to draw on; it may hold more than those with labels. With it cameras are known too.
        pictures: Where the pictures go. ``summary.txt``, ``summary.json`` and ``individual_results/`` go into the
            folder that this one lies in.
        scoring: How to score.
        progress: Called with steps done and steps in total; a step is an image scored or drawn.

    Raises:
        NotFound: If a folder doesn't exist.
        InvalidInput: If there are no labels, or two files are for one image.
        InvalidFile: If files can't be read; all of them are named.
        TooLarge: If a file is over the limits.
        OSError: If the results can't be written.
    """
    found_images = {} if images is None else find_images(images)
    task = _Task(
        open_segment_files(labels, "ground truth", found_images),
        open_segment_files(predictions, "predictions", found_images),
        scoring.min_length,
    )
    names = sorted({*task.truth.files, *task.truth.ambiguous})
    if not names:
        raise InvalidInput(
            "there are no label files",
            where=str(labels),
            expected="NAME.npy, .npz or .json, or NAME_edge_segments_filtered.npy, subfolders included",
        )
    infos = describe_images(names, images, found_images)
    drawn = [name for name in names if name in found_images]
    steps = _Steps(len(names) + len(drawn), progress)

    scored = _score_all(task, infos, scoring, steps)
    cameras = score_cameras([task.read(info) for info in infos if info.camera])
    records = [record for record, _ in scored]
    evaluation = Evaluation(
        protocol=scoring.protocol,
        names=tuple(names),
        scores=tuple(score for _, score in scored),
        totals=score_totals(infos, records, cameras, draws=scoring.draws, seed=scoring.seed),
        missing=tuple(name for name in names if name not in task.predictions.files),
        extra=tuple(sorted(set(task.predictions.files) - set(names))),
        min_length=scoring.min_length,
    )
    picture_errors = []
    for info, (record, score) in zip(infos, scored, strict=True):
        picture_errors += _write_image(task.read(info), record, score, pictures, found_images.get(info.name))
        if info.name in found_images:
            steps.done()
    folder = pictures.parent
    write_whole(folder / "summary.json", json_bytes(summary_content(evaluation)))
    write_whole(folder / "summary.txt", summary_text(evaluation).encode())
    without_picture = () if images is None else tuple(name for name in names if name not in found_images)
    return EvaluatedFolder(
        evaluation,
        _table(infos, records),
        folder,
        None if images is None else pictures,
        without_picture,
        tuple(picture_errors),
    )


class _Steps:
    """Counts steps for whoever shows the progress."""

    def __init__(self, total: int, progress: Progress | None) -> None:
        self.count, self.total, self.progress = 0, total, progress

    def done(self) -> None:
        self.count += 1
        if self.progress:
            self.progress(self.count, self.total)


def _score_all(
    task: _Task, infos: list[SplitImageInfo], scoring: Scoring, steps: _Steps
) -> list[tuple[ImageRecord, Score]]:
    scored: list[tuple[ImageRecord, Score]] = []
    errors: list[ClearLinesError] = []
    for info in infos:
        try:
            record, scores = score_image(task.read(info), scoring.min_length)
            scored.append((record, scores[scoring.protocol]))
        except ClearLinesError as error:
            errors.append(error)
        steps.done()
    if errors:
        raise one_error(errors)
    return scored


def _table(infos: list[SplitImageInfo], records: list[ImageRecord]) -> tuple[TableRow, ...]:
    tallies = {name: np.array([record.tallies[name] for record in records]) for name in SHOWN}
    return tuple(table_rows([info.source for info in infos], tallies))


def _write_image(
    image: ScoredImage, record: ImageRecord, score: Score, pictures: Path, file: Path | None
) -> list[ClearLinesError]:
    """Write what became of an image, and its picture if there is an image to draw on; return why it can't be drawn."""
    name = image.info.name
    write_whole(pictures.parent / "individual_results" / f"{name}.json", json_bytes(image_content(name, score, record)))
    if file is not None:
        scored = image.predictions.select(record.scored_predictions)
        try:
            write_picture(file, pictures / f"{name}.png", image.truth.segments, scored, score)
        except ClearLinesError as error:
            return [error]
    return []
