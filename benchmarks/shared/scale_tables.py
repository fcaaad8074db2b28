"""The rows of a large installation, table by table, as columns that COPY takes.

The large tables come in parts of some thousand images, so that no more than a part is in memory.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping

import numpy as np
from numpy.typing import NDArray
from shared.binary_copy import (
    Field,
    booleans,
    floats,
    hexadecimal,
    identifiers,
    integers,
    repeated,
    texts,
    times,
    words,
)
from shared.scale_world import BEGUN, DAY, DISCARDED, DONE, HIDDEN_DATASET, PEOPLE, SIZES, SOURCES, STATES, World

from app.evaluation.protocols import PROTOCOLS
from app.review.features import FEATURE_VERSION, FEATURES
from app.services.run_parameters import RunParameters
from app.services.suggestion_features import KnownFeatures, packed
from app.verdicts import REASONS

Columns = Mapping[str, Field]
PART = 2_000
"""Images of a part."""
VERDICTS = ("keep", "reject", "ambiguous")
SPLIT_IMAGES = 2_000
SUBMISSIONS = 40
SECOND_SHARE = 0.02
EVENTS = 200_000
AGAIN = 0.05
"""Share of candidates that are judged a second time."""


def small_tables(world: World, seed: int) -> Iterator[tuple[str, Columns]]:
    """Yield the tables whose size follows from the numbers of datasets, cameras and images."""
    random = np.random.default_rng([seed, 1])
    datasets = np.arange(len(world.first) - 1)
    cameras = np.arange(len(world.camera_dataset))
    images = np.arange(world.images)
    contents = hexadecimal(64, world.images, random)
    nothing = np.full(world.images, np.nan)
    named = words([f"dataset {number:02d}" for number in datasets], datasets)
    yield (
        "datasets",
        {
            "id": integers(datasets + 1),
            "slug": words([f"dataset-{number:02d}" for number in datasets], datasets),
            "name": named,
            "created_at": times(BEGUN + datasets * DAY),
        },
    )
    width, height = np.array(SIZES)[world.camera_source].T
    yield (
        "cameras",
        {
            "id": integers(cameras + 1),
            "dataset_id": integers(world.camera_dataset + 1),
            "name": texts([f"{SOURCES[world.camera_source[each]]} camera {each:03d}" for each in cameras]),
            "width": integers(width),
            "height": integers(height),
            "created_at": times(np.full(len(cameras), BEGUN)),
        },
    )
    yield (
        "blobs",
        {
            "sha256": contents,
            "size": integers(random.integers(200_000, 900_000, world.images)),
            "media_type": words(["image/png"], np.zeros(world.images, np.int64)),
            "created_at": times(world.added),
        },
    )
    names = world.names
    drives = [f"drive_{drive:04d}" for drive in range(int(world.sequence.max()) + 1)]
    width, height = np.array(SIZES)[world.source].T
    done = world.status == DONE
    kept = [np.where(done, world.candidates * part // 100, 0) for part in (45, 50)]
    yield (
        "images",
        {
            "id": integers(images + 1),
            "dataset_id": integers(world.dataset + 1),
            "name": texts(names),
            "file_name": texts([f"{name}.png" for name in names]),
            "sha256": contents,
            "width": integers(width),
            "height": integers(height),
            "bits": integers(np.full(world.images, 8)),
            "camera_id": integers(world.camera + 1),
            "source": words(SOURCES, world.source),
            "sequence": words(drives, world.sequence),
            "assignee": words(PEOPLE, world.assignee),
            "revision": integers(np.ones(world.images, np.int64)),
            "n_candidates": integers(world.candidates),
            "n_keep": integers(kept[0]),
            "n_reject": integers(kept[1]),
            "n_ambiguous": integers(np.where(done, world.candidates - kept[0] - kept[1], 0)),
            "current_run_image_id": integers(np.where(world.failed, -1, images + 1)),
            "created_at": times(world.added),
            "deleted_at": times(nothing),
        },
    )
    yield (
        "reviews",
        {
            "image_id": integers(images + 1),
            "status": words(STATES, world.status),
            "reason": words(["blurred"], np.where(world.status == DISCARDED, 0, -1)),
            "person": words(PEOPLE, np.where(np.isnan(world.reviewed), -1, world.person)),
            "updated_at": times(np.where(np.isnan(world.reviewed), world.added, world.reviewed)),
        },
    )
    yield from _runs(world)
    yield from _splits(world, contents, random)
    yield from _others(world, random)


def segments(world: World, seed: int) -> Iterator[Columns]:
    """Yield parts of the segments: the current ones of all images, then those that the second run replaced."""
    random = np.random.default_rng([seed, 2])
    next_id = 1
    for current in (True, False):
        counts = world.candidates if current else world.replaced
        for begin in range(0, world.images, PART):
            part = counts[begin : begin + PART]
            rows = int(part.sum())
            if not rows:
                continue
            index = np.repeat(np.arange(begin, begin + len(part)), part)
            ordinal = np.arange(rows) - np.repeat(np.cumsum(part) - part, part)
            retired = np.full(rows, np.nan) if current else world.added[index] + 20 * DAY
            work = index + 1 if current else world.images + _old_place(world)[index] + 1
            yield _segments(random, index, ordinal, next_id, work, retired, world)
            next_id += rows


def decisions(world: World, seed: int) -> Iterator[tuple[Columns, Columns]]:
    """Yield parts of the decisions with the states that follow from them."""
    random = np.random.default_rng([seed, 3])
    next_id = 1
    starts = world.starts
    for begin in range(0, world.images, PART):
        chosen = np.arange(begin, min(begin + PART, world.images))
        chosen = chosen[(world.status[chosen] == DONE) & (world.candidates[chosen] > 0)]
        if not len(chosen):
            continue
        counts = world.candidates[chosen]
        index = np.repeat(chosen, counts)
        place = np.arange(len(index)) - np.repeat(np.cumsum(counts) - counts, counts)
        verdict = np.digitize(place / world.candidates[index], [0.45, 0.95])
        again = random.random(len(index)) < AGAIN
        order = np.repeat(np.arange(len(index)), 1 + again)
        rows = len(order)
        last = np.concatenate([order[1:] != order[:-1], [True]])
        of_image, of_place, said = index[order], place[order], verdict[order]
        said = np.where(last, said, 1 - np.minimum(said, 1))
        segment = starts[of_image] + of_place
        reason = np.where((said == 1) & (random.random(rows) < 0.25), random.integers(0, len(REASONS), rows), -1)
        told = random.random(rows) < 0.5
        groups = repeated(identifiers(rows // 3 + 1, random), np.arange(rows) // 3)
        yield (
            {
                "id": integers(next_id + np.arange(rows)),
                "image_id": integers(of_image + 1),
                "segment_id": integers(segment),
                "person": words(PEOPLE, world.person[of_image]),
                "verdict": words(VERDICTS, said),
                "previous": words(["undecided"], np.zeros(rows, np.int64)),
                "kind": words(["judge"], np.zeros(rows, np.int64)),
                "client_id": identifiers(rows, random),
                "group_id": groups,
                "elapsed_ms": integers(random.lognormal(7, 0.8, rows).astype(np.int64)),
                "reason": words(REASONS, reason),
                "suggestion": floats(np.where(told, random.random(rows), np.nan)),
                "created_at": times(world.reviewed[of_image] - 120 + of_place),
            },
            {
                "segment_id": integers(segment[last]),
                "verdict": words(VERDICTS, said[last]),
                "reason": words(REASONS, reason[last]),
                "decision_id": integers((next_id + np.arange(rows))[last]),
            },
        )
        next_id += rows


def features(world: World, seed: int) -> Iterator[Columns]:
    """Yield parts of what the suggestions know of the candidates."""
    random = np.random.default_rng([seed, 4])
    starts = world.starts
    table = random.random((int(world.candidates.max()) + 1, len(FEATURES)), np.float32)
    for begin in range(0, world.images, PART):
        chosen = np.arange(begin, min(begin + PART, world.images))
        contents = []
        for image in chosen:
            count = int(world.candidates[image])
            ids = np.arange(starts[image], starts[image] + count)
            contents.append(packed(KnownFeatures(ids, table[:count], ids - starts[image], np.ones(count))))
        yield {
            "image_id": integers(chosen + 1),
            "revision": integers(np.ones(len(chosen), np.int64)),
            "version": words([f"{FEATURE_VERSION}-{'0' * 16}"], np.zeros(len(chosen), np.int64)),
            "content": Field(
                np.frombuffer(b"".join(contents), np.uint8), np.array([len(each) for each in contents], np.int64)
            ),
            "created_at": times(world.added[chosen] + DAY),
        }


def _segments(
    random: np.random.Generator,
    index: NDArray[np.int64],
    ordinal: NDArray[np.int64],
    first_id: int,
    work: NDArray[np.int64],
    retired: NDArray[np.float64],
    world: World,
) -> Columns:
    rows = len(index)
    n_points = np.clip(random.lognormal(3.2, 0.6, rows), 5, 200).astype(np.int64)
    width, height = np.array(SIZES)[world.source[index]].T
    length = n_points * 2.5
    angle = random.random(rows) * np.pi
    start = random.random((rows, 2)) * np.column_stack([width, height])
    step = np.column_stack([np.cos(angle), np.sin(angle)]) * 2.5
    which = np.repeat(np.arange(rows), n_points)
    along = np.arange(len(which)) - np.repeat(np.cumsum(n_points) - n_points, n_points)
    points = start[which] + along[:, None] * step[which] + random.normal(0, 0.1, (len(which), 2))
    end = start + step * (n_points - 1)[:, None]
    low, high = np.minimum(start, end), np.maximum(start, end)
    score = random.beta(4, 2, rows)
    return {
        "id": integers(first_id + np.arange(rows)),
        "image_id": integers(index + 1),
        "run_image_id": integers(work),
        "ordinal": integers(ordinal),
        "n_points": integers(n_points),
        "points": Field(points.astype("<f4").view(np.uint8).reshape(-1), n_points * 8),
        "x0": floats(low[:, 0]),
        "y0": floats(low[:, 1]),
        "x1": floats(high[:, 0]),
        "y1": floats(high[:, 1]),
        "length": floats(length),
        "residual": floats(random.gamma(2, 0.15, rows)),
        "score": floats(score),
        "straightness": floats(random.beta(3, 1, rows)),
        "origin": words(["pipeline"], np.zeros(rows, np.int64)),
        "retired_at": times(retired),
    }


def _old_place(world: World) -> NDArray[np.int64]:
    """Return the place of each image among those that the first runs took."""
    return np.cumsum(world.replaced > 0) - 1


def _runs(world: World) -> Iterator[tuple[str, Columns]]:
    """The second run of each dataset took all its images, the first one a part of them."""
    datasets = len(world.first) - 1
    number = np.arange(2 * datasets)
    later = number < datasets
    started = BEGUN + number % datasets * DAY + np.where(later, 20, 10) * DAY
    parameters = json.dumps(RunParameters(camera="per-image").as_dict())
    yield (
        "runs",
        {
            "id": integers(np.where(later, number + datasets, number - datasets) + 1),
            "dataset_id": integers(number % datasets + 1),
            "parameters": words([parameters], np.zeros(len(number), np.int64)),
            "code_version": words(["0.6.0"], np.zeros(len(number), np.int64)),
            "status": words(["done"], np.zeros(len(number), np.int64)),
            "created_at": times(started),
            "started_at": times(started + 1),
            "finished_at": times(started + 3600),
        },
    )
    old = np.flatnonzero(world.replaced > 0)
    image = np.concatenate([np.arange(world.images), old])
    is_old = np.arange(len(image)) >= world.images
    failed = np.concatenate([world.failed, np.zeros(len(old), bool)])
    found = np.concatenate([world.candidates, world.replaced[old]])
    retired = np.concatenate([world.replaced, np.zeros(len(old), np.int64)])
    changes = [
        json.dumps(
            {
                "candidates": int(count),
                "carried": 0,
                "kept_unmatched": 0,
                "already_there": 0,
                "retired": int(gone),
                "reopened": False,
            }
        )
        for count, gone in zip(found, retired, strict=True)
    ]
    error = json.dumps({"code": "invalid-image", "message": "the file ends too early"})
    yield (
        "run_images",
        {
            "id": integers(np.arange(len(image)) + 1),
            "run_id": integers(world.dataset[image] + 1 + np.where(is_old, 0, datasets)),
            "image_id": integers(image + 1),
            "status": words(["done", "failed"], failed.astype(np.int64)),
            "attempts": integers(np.ones(len(image), np.int64)),
            "heartbeat_at": times(world.added[image] + np.where(is_old, 10, 20) * DAY),
            "error": words([error], np.where(failed, 0, -1)),
            "milliseconds": floats(np.where(failed, np.nan, 180.0)),
            "changes": texts(changes),
        },
    )


def _splits(world: World, contents: Field, random: np.random.Generator) -> Iterator[tuple[str, Columns]]:
    """An open split of the largest dataset, and a hidden one."""
    parts = []
    for dataset in (0, HIDDEN_DATASET):
        begin, end = world.first[dataset], world.first[dataset + 1]
        parts.append(np.arange(begin, min(end, begin + max(2, round(SPLIT_IMAGES * world.share)))))
    image = np.concatenate(parts)
    version = np.repeat([1, 2], [len(part) for part in parts])
    splits = np.arange(2)
    hashes = hexadecimal(64, 2, random)
    yield (
        "blobs",
        {
            "sha256": hashes,
            "size": integers([1000, 1000]),
            "media_type": words(["application/zip"], np.zeros(2, np.int64)),
            "created_at": times(np.full(2, BEGUN)),
        },
    )
    yield (
        "splits",
        {
            "id": integers(splits + 1),
            "dataset_id": integers([1, HIDDEN_DATASET + 1]),
            "slug": words(["open-split", "hidden-split"], splits),
            "name": words(["open split", "hidden split"], splits),
            "min_length": floats(np.full(2, 20.0)),
            "visibility": words(["open", "hidden"], splits),
            "daily_limit": integers([10, 10]),
            "created_at": times(np.full(2, BEGUN + 100 * DAY)),
        },
    )
    yield (
        "split_versions",
        {
            "id": integers(splits + 1),
            "split_id": integers(splits + 1),
            "number": integers([1, 1]),
            "truth_sha256": hashes,
            "truth_hash": hexadecimal(64, 2, random),
            "n_images": integers([len(part) for part in parts]),
            "n_labels": integers([45 * len(part) for part in parts]),
            "n_ambiguous": integers([5 * len(part) for part in parts]),
            # after the last decision: whether the labels changed since is looked up, and found not to be so
            "created_at": times(np.full(2, BEGUN + 500 * DAY)),
        },
    )
    names = world.names
    yield (
        "split_images",
        {
            "id": integers(np.arange(len(image)) + 1),
            "version_id": integers(version),
            "ordinal": integers(np.concatenate([np.arange(len(part)) for part in parts])),
            "image_id": integers(image + 1),
            "name": texts([names[each] for each in image]),
            "image_sha256": repeated(contents, image),
            "width": integers(np.full(len(image), 1280)),
            "height": integers(np.full(len(image), 720)),
            "source": words(SOURCES, world.source[image]),
            "sequence": texts([f"drive_{drive:04d}" for drive in world.sequence[image]]),
            "n_labels": integers(np.full(len(image), 45)),
        },
    )
    yield from _submissions(parts, random)


def _submissions(parts: list[NDArray[np.int64]], random: np.random.Generator) -> Iterator[tuple[str, Columns]]:
    number = np.arange(SUBMISSIONS)
    version = number % 2 + 1
    made = BEGUN + (200 + number) * DAY
    protocol = PROTOCOLS["clearlines-v2"]
    quality = 0.3 + 0.015 * number
    yield (
        "methods",
        {
            "id": integers(number + 1),
            "slug": texts([f"method-{each:02d}" for each in number]),
            "name": texts([f"method {each:02d}" for each in number]),
            "owner": words(PEOPLE, number % len(PEOPLE)),
            "anonymous": booleans(np.zeros(SUBMISSIONS, bool)),
            "kind": words(["method"], np.zeros(SUBMISSIONS, np.int64)),
            "created_at": times(made),
        },
    )
    yield (
        "submissions",
        {
            "id": integers(number + 1),
            "split_version_id": integers(version),
            "method_id": integers(number + 1),
            "person": words(PEOPLE, number % len(PEOPLE)),
            "status": words(["scored"], np.zeros(SUBMISSIONS, np.int64)),
            "visibility": words(["public"], np.zeros(SUBMISSIONS, np.int64)),
            "n_images": integers(np.array([len(parts[each]) for each in version - 1])),
            "n_segments": integers(np.full(SUBMISSIONS, 100_000)),
            "n_points": integers(np.full(SUBMISSIONS, 3_000_000)),
            "has_scores": booleans(np.ones(SUBMISSIONS, bool)),
            "attempts": integers(np.ones(SUBMISSIONS, np.int64)),
            "created_at": times(made),
            "scored_at": times(made + 60),
        },
    )
    totals = [json.dumps({"f1": {"value": each, "low": each - 0.02, "high": each + 0.02}}) for each in quality]
    yield (
        "scores",
        {
            "id": integers(number + 1),
            "submission_id": integers(number + 1),
            "split_version_id": integers(version),
            "protocol": words([protocol.name], np.zeros(SUBMISSIONS, np.int64)),
            "protocol_version": words([protocol.version], np.zeros(SUBMISSIONS, np.int64)),
            "scorer_version": words(["1"], np.zeros(SUBMISSIONS, np.int64)),
            "truth_hash": hexadecimal(64, SUBMISSIONS, random),
            "submission_hash": hexadecimal(64, SUBMISSIONS, random),
            "status": words(["done"], np.zeros(SUBMISSIONS, np.int64)),
            "f1": floats(quality),
            "totals": texts(totals),
            "created_at": times(made),
            "done_at": times(made + 60),
        },
    )
    first = np.array([1, 1 + len(parts[0])])
    score = np.repeat(number, [len(parts[each]) for each in version - 1])
    place = np.concatenate([np.arange(len(parts[each])) for each in version - 1])
    found = random.integers(0, 45, len(score))
    yield (
        "image_scores",
        {
            "id": integers(np.arange(len(score)) + 1),
            "score_id": integers(score + 1),
            "split_image_id": integers(first[version[score] - 1] + place),
            "f1": floats(found / 45),
            "tp": integers(found),
            "fp": integers(45 - found),
            "fn": integers(45 - found),
        },
    )


def _others(world: World, random: np.random.Generator) -> Iterator[tuple[str, Columns]]:
    """Second reviews, models, calibrations and the audit."""
    done = np.flatnonzero((world.status == DONE) & (world.candidates > 0))
    twice = done[:: round(1 / SECOND_SHARE)]
    second = (world.person[twice] + 1) % len(PEOPLE)
    yield (
        "second_reviews",
        {
            "id": integers(np.arange(len(twice)) + 1),
            "image_id": integers(twice + 1),
            "person": words(PEOPLE, second),
            "status": words(["done"], np.zeros(len(twice), np.int64)),
            "first_decision_id": integers(np.full(len(twice), 2**31 - 1)),
            "created_at": times(world.reviewed[twice] + DAY),
            "done_at": times(world.reviewed[twice] + 2 * DAY),
        },
    )
    counts = world.candidates[twice]
    review = np.repeat(np.arange(len(twice)), counts)
    rows = len(review)
    place = np.arange(rows) - np.repeat(np.cumsum(counts) - counts, counts)
    verdict = np.digitize(place / np.repeat(counts, counts) + random.normal(0, 0.05, rows), [0.45, 0.95])
    yield (
        "second_decisions",
        {
            "id": integers(np.arange(rows) + 1),
            "second_review_id": integers(review + 1),
            "segment_id": integers(world.starts[twice][review] + place),
            "person": words(PEOPLE, second[review]),
            "verdict": words(VERDICTS, verdict),
            "previous": words(["undecided"], np.zeros(rows, np.int64)),
            "kind": words(["judge"], np.zeros(rows, np.int64)),
            "client_id": identifiers(rows, random),
            "group_id": identifiers(rows, random),
            "created_at": times(world.reviewed[twice][review] + DAY + place),
        },
    )
    datasets = np.arange(len(world.first) - 1)
    judged = np.bincount(world.dataset[done], weights=world.candidates[done], minlength=len(datasets))
    yield (
        "suggestion_models",
        {
            "id": integers(datasets + 1),
            "dataset_id": integers(datasets + 1),
            "version": words([FEATURE_VERSION], np.zeros(len(datasets), np.int64)),
            "n_decisions": integers(judged.astype(np.int64) + 1),
            "n_images": integers(np.bincount(world.dataset[done], minlength=len(datasets))),
            "last_decision_id": integers(np.ones(len(datasets), np.int64)),
            "parameters": words(["{}"], np.zeros(len(datasets), np.int64)),
            "report": words(["{}"], np.zeros(len(datasets), np.int64)),
            "created_at": times(np.full(len(datasets), BEGUN + 400 * DAY)),
        },
    )
    cameras = np.arange(len(world.camera_dataset))
    yield (
        "calibrations",
        {
            "id": integers(cameras + 1),
            "camera_id": integers(cameras + 1),
            "source": words(["labels"], np.zeros(len(cameras), np.int64)),
            "status": words(["done"], np.zeros(len(cameras), np.int64)),
            "attempts": integers(np.ones(len(cameras), np.int64)),
            "parameters": words(['{"images": [], "newest_decision": 2147483647}'], np.zeros(len(cameras), np.int64)),
            "code_version": words(["0.6.0"], np.zeros(len(cameras), np.int64)),
            "n_images": integers(np.full(len(cameras), 100)),
            "n_segments": integers(np.full(len(cameras), 4_500)),
            "created_at": times(np.full(len(cameras), BEGUN + 400 * DAY)),
            "finished_at": times(np.full(len(cameras), BEGUN + 400 * DAY + 60)),
        },
    )
    events = max(10, round(EVENTS * world.share))
    yield (
        "events",
        {
            "id": integers(np.arange(events) + 1),
            "dataset_id": integers(random.integers(0, len(datasets), events) + 1),
            "kind": words(["image.reviewed"], np.zeros(events, np.int64)),
            "person": words(PEOPLE, random.integers(0, len(PEOPLE), events)),
            "details": words(['{"image": 1, "from": "open", "to": "done"}'], np.zeros(events, np.int64)),
            "created_at": times(BEGUN + 400 * DAY * np.arange(events) / events),
        },
    )
