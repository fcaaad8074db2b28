"""Freezing on both databases, and what the purge leaves alone."""

from __future__ import annotations

from datetime import datetime, timedelta
from uuid import uuid4

import numpy as np
import pytest

from app.db.models import Blob, Dataset, Image, Method, Split, SplitImage, SplitVersion, Submission
from app.errors import NotFound
from app.evaluation.rejected_lines import RejectedLines
from app.formats.labelled import LabelledSegments
from app.services.access import Viewer
from app.services.blobs import keep_bytes
from app.services.concealing import require_details, require_visible, visible_datasets
from app.services.dataset_overviews import list_datasets
from app.services.datasets import delete_dataset
from app.services.deciding import decide
from app.services.decision_batch import Wish
from app.services.freezing import NotFrozen
from app.services.labelling import segments_of_image
from app.services.purging import purge
from app.services.reviews import set_review
from app.services.scoring_inputs import images_to_score
from app.services.split_overviews import labels_since
from app.services.splits import SplitPlan, create_split, current_version, freeze_again, get_split
from app.services.truths import ground_truths, read_truth, read_truth_with_reasons, truth_hash
from app.verdicts import REASONS
from app.vision.segments import Segments

GRACE = timedelta(days=7)
READER = Viewer(None, "reader", anonymous=True)
MAINTAINER = Viewer("ada", "maintainer")


def labelled_image(place, slug: str, name: str, verdicts: list[str], **given) -> int:
    image = place.image(slug, name, **given)
    place.label(image, verdicts)
    with place.database.write() as session:
        set_review(session, image, "done", now=place.now, allow_undecided=True)
    return image


def freeze(place, slug: str, **given) -> str:
    with place.database.write() as session:
        return create_split(session, place.blobs, slug, SplitPlan("Test", **given), place.now, person="ada").slug


def test_a_version_holds_all_that_scoring_needs(place) -> None:
    slug = place.dataset()
    labelled_image(place, slug, "b", ["keep", "ambiguous", "reject"], sequence="drive")
    labelled_image(place, slug, "a", ["keep"], source="city")
    place.image(slug, "open")
    split = freeze(place, slug, min_length=5.0)
    with place.database.read() as session:
        version = current_version(session, get_split(session, split))
        assert (version.number, version.n_images, version.n_labels, version.n_ambiguous) == (1, 2, 2, 1)
        rows = session.query(SplitImage).order_by(SplitImage.ordinal).all()
        assert [(row.name, row.source, row.sequence, row.n_labels) for row in rows] == [
            ("a", "city", None, 1),
            ("b", None, "drive", 1),
        ]
        truth = ground_truths(read_truth(place.blobs, version), 5.0)
    assert truth["b"].ignored.tolist() == [False, True]
    assert truth["a"].ignored.tolist() == [False]


def test_labels_shorter_than_the_minimum_are_ignored(place) -> None:
    slug = place.dataset()
    labelled_image(place, slug, "a", ["keep"])
    with pytest.raises(NotFrozen, match="no label"):
        freeze(place, slug, min_length=1_000.0)
    with place.database.read() as session:
        assert session.query(Split).count() == 0


def test_the_hash_tells_verdicts_points_and_names_apart() -> None:
    def labelled(verdict: str = "keep", x: float = 0.0) -> LabelledSegments:
        return LabelledSegments(Segments.from_list([np.array([[x, 0], [9, 0]])]), verdicts=(verdict,))

    both = Segments.from_list([np.array([[0, 0], [9, 0]]), np.array([[1, 1], [9, 9]])])
    turned = Segments.from_list([np.array([[1, 1], [9, 9]]), np.array([[0, 0], [9, 0]])])
    hashes = [
        truth_hash({"a": labelled()}, 0.0),
        truth_hash({"a": labelled()}, 1.0),
        truth_hash({"b": labelled()}, 0.0),
        truth_hash({"a": labelled("ambiguous")}, 0.0),
        truth_hash({"a": labelled(x=1.0)}, 0.0),
        truth_hash({"a": labelled(), "b": LabelledSegments(Segments.empty(), verdicts=())}, 0.0),
        truth_hash({"a": LabelledSegments(both, verdicts=("keep", "keep"))}, 0.0),
        truth_hash({"a": LabelledSegments(both, verdicts=("keep", "ambiguous"))}, 0.0),
    ]
    assert len(set(hashes)) == len(hashes)
    assert truth_hash({"a": LabelledSegments(turned, verdicts=("keep", "keep"))}, 0.0) == hashes[6]
    assert truth_hash({"a": LabelledSegments(turned, verdicts=("ambiguous", "keep"))}, 0.0) == hashes[7]


def test_candidates_rejected_with_a_reason_go_along(place) -> None:
    slug = place.dataset()
    image = labelled_image(place, slug, "a", ["keep", "reject", "reject"])
    labelled_image(place, slug, "b", ["keep", "reject"])
    split = freeze(place, slug)
    with place.database.read() as session:
        assert [row.rejected for row in session.query(SplitImage)] == [None, None]
        plain = current_version(session, get_split(session, split))
        labels = read_truth(place.blobs, plain)
        candidates = segments_of_image(session, image).segments
        assert plain.truth_hash == truth_hash(labels, 0.0) == truth_hash(labels, 0.0, {})
    shadow = Wish(str(uuid4()), str(uuid4()), candidates[2].id, "reject", reason="shadow")
    with place.database.write() as session:
        decide(session, image, [shadow], "ada", place.now)
    with place.database.read() as session:
        assert labels_since(session, place.blobs, get_split(session, split)).changed == ("a",)
    with place.database.write() as session:
        freeze_again(session, place.blobs, split, None, place.now)
    with place.database.read() as session:
        assert labels_since(session, place.blobs, get_split(session, split)).changed == ()
        version = current_version(session, get_split(session, split))
        assert (version.number, version.n_labels) == (2, 2)
        again = read_truth(place.blobs, version)
        assert {name: len(part) for name, part in again.items()} == {"a": 1, "b": 1}
        first, second = session.query(SplitImage).filter_by(version_id=version.id).order_by(SplitImage.ordinal)
        assert second.rejected is None
        rejected = RejectedLines.from_npz(first.rejected)
        assert version.truth_hash == truth_hash(labels, 0.0, {"a": rejected}) != plain.truth_hash
        (scored,) = images_to_score(session, [first.id], again, {}, 0.0)
        assert scored.rejected is not None
        assert scored.rejected.reasons.tolist() == [REASONS.index("shadow")]
        told = read_truth_with_reasons(session, place.blobs, version)
        assert {name: part.verdicts for name, part in told.items()} == {"a": ("keep", "reject"), "b": ("keep",)}
        assert told["a"].reasons == (None, "shadow")
        assert np.array_equal(told["a"].segments[1], rejected.segments[0])
        assert read_truth_with_reasons(session, place.blobs, plain) == labels
    assert [REASONS[reason] for reason in rejected.reasons] == ["shadow"]
    assert rejected.segments.boxes()[0].tolist() == pytest.approx(candidates[2].box)


def test_the_purge_leaves_what_splits_and_submissions_name(place) -> None:
    slug = place.dataset()
    labelled_image(place, slug, "a", ["keep"])
    place.image(slug, "unused")
    split = freeze(place, slug)
    with place.database.write() as session:
        method = Method(slug="m", name="m", created_at=place.now, anonymous=False)
        session.add(method)
        session.flush()
        session.add(
            Submission(
                split_version_id=current_version(session, get_split(session, split)).id,
                method_id=method.id,
                upload_sha256=keep_bytes(session, place.blobs, b"upload", "application/zip", place.now),
                segments_sha256=keep_bytes(session, place.blobs, b"segments", "application/x-npz", place.now),
                created_at=place.now,
            )
        )
        keep_bytes(session, place.blobs, b"nobody's", "text/plain", place.now)
        delete_dataset(session, slug, place.now, grace=GRACE)
    purged = purge(place.database, place.blobs, place.now + GRACE, grace=GRACE)
    assert (purged.datasets, purged.images, purged.blobs) == (1, 2, 2)
    with place.database.read() as session:
        assert [session.query(table).count() for table in (Dataset, Image, SplitVersion, SplitImage)] == [0, 0, 1, 1]
        assert session.query(Blob).count() == 4
        version = current_version(session, get_split(session, split))
        assert list(read_truth(place.blobs, version)) == ["a"]
        image = session.query(SplitImage).one()
        assert image.image_id is None
        assert place.blobs.exists(image.image_sha256)
    with place.database.write() as session, pytest.raises(NotFound):
        freeze_again(session, place.blobs, split, None, place.now)


def test_what_a_hidden_split_conceals(place) -> None:
    secret, copy, street = (place.dataset(name) for name in ("Secret", "Copy", "Street"))
    hidden = labelled_image(place, secret, "a", ["keep"], seed=7)
    place.image(copy, "b", seed=7)
    other = place.image(street, "c", seed=8)
    freeze(place, secret, visibility="hidden")
    with place.database.read() as session:
        assert [each.slug for each in list_datasets(session, grace=GRACE, viewer=READER)] == [street]
        assert len(list_datasets(session, grace=GRACE, viewer=MAINTAINER)) == 3
        assert visible_datasets(MAINTAINER) is None
        for named in ({"dataset": secret}, {"dataset": copy}, {"image_id": str(hidden)}, {"image_id": "01"}):
            with pytest.raises(NotFound):
                require_visible(session, READER, named)
            require_visible(session, MAINTAINER, named)
        require_visible(session, READER, {"dataset": street, "image_id": str(other)})
        require_details(session, READER, ["77"])
        with pytest.raises(NotFound):
            require_details(session, READER, ["+1"])


def test_concealment_lasts_when_the_images_are_gone_from_their_dataset(place, now: datetime) -> None:
    secret = place.dataset("Secret")
    hidden = labelled_image(place, secret, "a", ["keep"], seed=7)
    freeze(place, secret, visibility="hidden")
    place.image(secret, "b", seed=9)
    with place.database.write() as session:
        session.delete(session.get_one(Image, hidden))
    with place.database.read() as session, pytest.raises(NotFound):
        require_visible(session, READER, {"dataset": secret})
