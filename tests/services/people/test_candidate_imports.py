"""Predictions of any detector become candidates, each once."""

from __future__ import annotations

import numpy as np
import pytest
from sqlalchemy import select

from app.db.models import Event, Image, Review, Segment
from app.formats.labelled import LabelledSegments
from app.services.candidate_imports import CandidateImport, images_to_predict, import_candidates
from app.services.labelling import segments_of_image
from app.services.labels import ImageLabels, import_labels
from app.vision.segments import Segments


def predicted(*heights: float, length: float = 120.0) -> LabelledSegments:
    x = np.arange(5.0, 5.0 + length + 1)
    polylines = [np.stack([x, np.full_like(x, height)], axis=1) for height in heights]
    return LabelledSegments(Segments.from_list(polylines, np.linspace(0.5, 0.9, len(heights))))


def take(office, predictions: dict[str, LabelledSegments]) -> CandidateImport:
    return import_candidates(office.database, office.dataset_id, predictions, "p.npz", office.now, person="Mara")


def current(office, image_id: int) -> list[tuple[str, str, float]]:
    with office.database.read() as session:
        found = segments_of_image(session, image_id).segments
    return [(segment.origin, segment.verdict, segment.box[1]) for segment in found]


def test_what_is_new_becomes_an_undecided_candidate(office) -> None:
    # the third candidate, of 150 px at height 50, is there already
    report = take(office, {"frame-0": predicted(51, 120, 140)})
    assert report == CandidateImport(images=1, added=2, duplicates=1, reopened=0)
    assert current(office, office.first)[4:] == [("import", "undecided", 120.0), ("import", "undecided", 140.0)]
    with office.database.read() as session:
        image = session.get_one(Image, office.first)
        scores = session.scalars(select(Segment.score).where(Segment.origin == "import").order_by(Segment.score)).all()
        event = session.scalars(select(Event).where(Event.kind == "candidates.imported")).one()
    assert (image.n_candidates, image.revision, scores) == (6, 1, [pytest.approx(0.7), pytest.approx(0.9)])
    assert (event.person, event.details["added"]) == ("Mara", 2)


def test_the_same_import_again_changes_nothing(office) -> None:
    predictions = {"frame-0": predicted(120, 140), "frame-1": predicted(120)}
    assert take(office, predictions).added == 3
    retired = office.segments[office.first][0]
    with office.database.write() as session:
        session.get_one(Segment, retired).retired_at = office.now
        imported = session.scalars(select(Segment).where(Segment.origin == "import")).all()
        imported[0].retired_at = office.now
    assert take(office, predictions) == CandidateImport(images=2, added=0, duplicates=3, reopened=0)


def test_one_prediction_twice_in_a_file_is_one(small_office) -> None:
    assert take(small_office, {"frame-0": predicted(120, 120)}).added == 1


def test_a_done_image_is_open_again(small_office) -> None:
    office = small_office
    office.finish(office.first, "krrr")
    assert take(office, {"frame-0": predicted(50)}).reopened == 0
    assert take(office, {"frame-0": predicted(120)}).reopened == 1
    with office.database.read() as session:
        assert session.get_one(Review, office.first).status == "open"


def test_labels_can_still_be_imported_afterwards_once(small_office) -> None:
    office = small_office
    take(office, {"frame-0": predicted(120)})
    labels = ImageLabels(predicted(150))
    for expected in (True, False):
        with office.database.write() as session:
            assert import_labels(session, session.get_one(Image, office.first), labels, office.now) is expected
    assert current(office, office.first)[4:] == [("import", "undecided", 120.0), ("import", "keep", 150.0)]


def test_images_that_are_deleted_get_nothing(small_office) -> None:
    office = small_office
    with office.database.write() as session:
        session.get_one(Image, office.first).deleted_at = office.now
        assert [image.name for image in images_to_predict(session, office.dataset(session))] == ["frame-1", "frame-2"]
    assert take(office, {"frame-0": predicted(120)}).added == 0
