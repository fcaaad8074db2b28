"""Pre-labelling: detection, lens and straightness together."""

from __future__ import annotations

import pickle
from dataclasses import replace

import numpy as np
import pytest

from app.errors import InvalidInput
from app.vision import Detection, DetectionParameters, Segments, assemble, detect_for_prelabel, prelabel
from app.vision.brown import Brown

WIDTH, HEIGHT = 320, 240


def picture(seed: int, shape: tuple[int, int] = (HEIGHT, WIDTH)) -> np.ndarray:
    """Grey bars of random width, a little noisy."""
    generator = np.random.default_rng(seed)
    steps = generator.uniform(0, 1, shape[1]) < 0.05
    columns = np.cumsum(steps) % 2 * 120.0 + 60
    image = np.tile(columns, (shape[0], 1)) + generator.normal(0, 2, shape)
    return image.clip(0, 255).astype(np.uint8)


def test_every_image_gets_candidates_scores_and_straightness():
    told: list[tuple[int, int]] = []
    result = prelabel([picture(0), picture(1)], progress=lambda done, total: told.append((done, total)))
    assert told == [(1, 2), (2, 2)]
    assert [camera.images for camera in result.cameras] == [(0, 1)]
    for image in result.images:
        assert len(image.segments) > 0
        assert image.segments.extents().min() >= 100
        assert image.straightness.shape == (len(image.segments),)
        assert image.segments.scores is not None
        assert ((image.segments.scores >= 0) & (image.segments.scores <= 1)).all()
        assert image.seconds > 0


def test_per_image_gives_each_its_own_lens():
    result = prelabel([picture(0), picture(1, (200, 300))], camera="per-image")
    assert [camera.images for camera in result.cameras] == [(0,), (1,)]
    assert [(each.estimate.width, each.estimate.height) for each in result.cameras] == [(320, 240), (300, 200)]


def test_images_of_different_size_share_no_lens():
    images = [picture(0), picture(1, (200, 300)), picture(2)]
    with pytest.raises(InvalidInput, match=r"image 1 \(300 x 200\)") as refusal:
        prelabel(images)
    assert refusal.value.details == {"images": [1]}


def test_an_unknown_way_to_share_lenses_is_refused():
    with pytest.raises(InvalidInput, match="no way to share"):
        prelabel([], camera="all")  # type: ignore[arg-type]


def test_nothing_gives_nothing():
    assert prelabel([]).images == ()
    assert prelabel([], camera="per-image").cameras == ()


def test_a_constant_image_has_no_candidates_and_no_lens():
    result = prelabel([np.full((HEIGHT, WIDTH), 90, np.uint8)])
    assert len(result.images[0].segments) == 0
    assert not result.cameras[0].estimate.accepted


def test_one_pass_serves_candidates_and_lens():
    detection = detect_for_prelabel(picture(3), DetectionParameters(min_length=150))
    assert detection.candidates.extents().min() >= 150
    assert len(detection.lens_segments) >= len(detection.candidates)
    assert (detection.width, detection.height) == (WIDTH, HEIGHT)
    short = detect_for_prelabel(picture(3), DetectionParameters(min_length=20))
    assert short.lens_segments.extents().min() >= 60


def test_a_detection_crosses_a_process_border():
    detection = detect_for_prelabel(picture(4), DetectionParameters())
    copy = pickle.loads(pickle.dumps(detection))
    assert copy.candidates == detection.candidates
    assert copy.lens_segments == detection.lens_segments


def test_the_parts_give_what_the_whole_does():
    images = [picture(5), picture(6)]
    whole = prelabel(images)
    parts = assemble([detect_for_prelabel(image, DetectionParameters()) for image in images])
    assert [a.segments == b.segments for a, b in zip(whole.images, parts.images, strict=True)] == [True, True]
    assert whole.cameras[0].estimate.as_dict() == parts.cameras[0].estimate.as_dict()


def test_a_shared_lens_judges_each_image(segments_through):
    lens = Brown(640, 480, (319.5, 239.5), 400.0, (0.2, 0.0, 0.0))
    many, few = segments_through(lens, 120), segments_through(lens, 2, bent=0.5, seed=5)
    detections = [Detection(640, 480, segments, segments, 0.1) for segments in (many, few)]
    joint = assemble(detections)
    assert joint.cameras[0].estimate.accepted
    assert (joint.images[1].straightness >= 0.5).tolist() == [False, True]
    alone = assemble(detections, camera="per-image")
    assert not alone.cameras[1].estimate.accepted
    with pytest.raises(InvalidInput, match="different size"):
        assemble([detections[0], replace(detections[1], width=641)])


def test_segments_without_any_detection_are_judged_by_nobody():
    result = assemble([Detection(640, 480, Segments.empty(), Segments.empty(), 0.0)])
    assert result.images[0].straightness.shape == (0,)
