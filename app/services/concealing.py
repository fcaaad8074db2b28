"""What hidden splits conceal from everyone below maintainer.

The labels of a hidden split could be learnt from more than its truth: from candidates and decisions, from counts of
verdicts, from exports, runs and lenses, and from a copy of an image in another dataset. So a dataset is concealed as a
whole when one of its images has the content of a hidden split's image, or a hidden split was made from it; with it
goes everything that lies in it. To a viewer who may not see it, it isn't there: the answer is that of an address
that never was. Deleted splits and deleted images conceal as living ones do.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

from sqlalchemy import ColumnElement, Select, and_, exists, or_, select
from sqlalchemy.orm import Session

from app.db.models import (
    Calibration,
    Camera,
    Dataset,
    Image,
    Run,
    SecondReview,
    Segment,
    Split,
    SplitImage,
    SplitVersion,
    Submission,
)
from app.errors import NotFound
from app.services.access import Viewer, can_see_hidden


def hidden_contents() -> Select[str]:
    """Select the sha256 of every image of every hidden split, of all its versions."""
    return (
        select(SplitImage.image_sha256)
        .join(SplitVersion, SplitVersion.id == SplitImage.version_id)
        .join(Split, Split.id == SplitVersion.split_id)
        .where(Split.visibility == "hidden")
    )


def open_contents() -> Select[str]:
    """Select the sha256 of every image of every open split, of all its versions: their labels are public."""
    return (
        select(SplitImage.image_sha256)
        .join(SplitVersion, SplitVersion.id == SplitImage.version_id)
        .join(Split, Split.id == SplitVersion.split_id)
        .where(Split.visibility == "open")
    )


def is_concealed_dataset() -> ColumnElement[bool]:
    """Return the rule as a condition on ``Dataset``, for any query that has it in its FROM."""
    # from the hidden images, of which there are few, to the dataset's by an index: never through all of a dataset
    hidden = hidden_contents().subquery()
    inside = exists().where(Image.dataset_id == Dataset.id, Image.sha256 == hidden.c.image_sha256)
    holds_one = exists().select_from(hidden).where(inside.correlate(Dataset, hidden)).correlate(Dataset)
    made_from = exists().where(Split.dataset_id == Dataset.id, Split.visibility == "hidden").correlate(Dataset)
    return or_(holds_one, made_from)


def visible_datasets(viewer: Viewer | None) -> ColumnElement[bool] | None:
    """Return the condition that leaves out datasets that are concealed from the viewer; ``None`` if none are.

    Args:
        viewer: Who asks; ``None`` where no person does, as on the command line.
    """
    if viewer is None or can_see_hidden(viewer):
        return None
    # all concealed datasets at once, found from the hidden images, where the rule would look for these in each dataset
    hidden = hidden_contents().subquery()
    holding = select(Image.dataset_id).join(hidden, hidden.c.image_sha256 == Image.sha256)
    sources = select(Split.dataset_id).where(Split.visibility == "hidden", Split.dataset_id.is_not(None))
    return and_(Dataset.id.not_in(holding), Dataset.id.not_in(sources))


def require_visible(session: Session, viewer: Viewer, named: Mapping[str, str]) -> None:
    """Refuse what is concealed from the viewer, as if it weren't there.

    Args:
        session: Any session.
        viewer: Who asks.
        named: What the address names: ``dataset`` (its slug), ``image_id``, ``segment_id``, ``run_id``, ``camera_id``,
            ``calibration_id``, ``second_review_id``, as text.

    Raises:
        NotFound: When one of them lies in a concealed dataset; also on an id that isn't written in plain digits,
            since whoever reads it later may take it for another one.
    """
    if can_see_hidden(viewer):
        return
    for name, value in named.items():
        of_thing = _DATASET_OF.get(name)
        if of_thing is None:
            continue
        if name != "dataset" and not _is_plain_id(value):
            raise NotFound("there is nothing at this address")
        concealed = select(Dataset.id).where(Dataset.id.in_(of_thing(value)), is_concealed_dataset())
        if session.scalar(concealed.limit(1)) is not None:
            raise _not_there(name, value)


def require_details(session: Session, viewer: Viewer, submission_ids: Collection[str]) -> None:
    """Refuse what of a submission labels could be learnt from, when its split is hidden.

    Args:
        session: Any session.
        viewer: Who asks.
        submission_ids: Submissions that the address names, as text.

    Raises:
        NotFound: When one of them is on a hidden split and the viewer is below maintainer; also on an id that isn't
            written in plain digits.
    """
    if can_see_hidden(viewer):
        return
    for value in submission_ids:
        if not _is_plain_id(value):
            raise NotFound("there is nothing at this address")
        hidden = (
            select(Submission.id)
            .join(SplitVersion, SplitVersion.id == Submission.split_version_id)
            .join(Split, Split.id == SplitVersion.split_id)
            .where(Submission.id == int(value), Split.visibility == "hidden")
        )
        if session.scalar(hidden) is not None:
            raise NotFound("there is nothing at this address", hint="a hidden split shows totals alone")


def no_such_dataset(slug: str) -> NotFound:
    """Return the error of a dataset that isn't there, or that the viewer isn't to know of."""
    return NotFound(f"there is no dataset {slug}", hint="the list of datasets shows their slugs")


def _of_slug(slug: str) -> Select[int]:
    return select(Dataset.id).where(Dataset.slug == slug if slug.isascii() else Dataset.id.is_(None))


def _of_image(value: str) -> Select[int]:
    return select(Image.dataset_id).where(Image.id == int(value))


def _of_segment(value: str) -> Select[int]:
    return select(Image.dataset_id).join(Segment, Segment.image_id == Image.id).where(Segment.id == int(value))


def _of_run(value: str) -> Select[int]:
    return select(Run.dataset_id).where(Run.id == int(value))


def _of_camera(value: str) -> Select[int]:
    return select(Camera.dataset_id).where(Camera.id == int(value))


def _of_calibration(value: str) -> Select[int]:
    return (
        select(Camera.dataset_id)
        .join(Calibration, Calibration.camera_id == Camera.id)
        .where(Calibration.id == int(value))
    )


def _of_second_review(value: str) -> Select[int]:
    second = select(SecondReview.image_id).where(SecondReview.id == int(value))
    return select(Image.dataset_id).where(Image.id.in_(second))


_DATASET_OF: Mapping[str, Callable[[str], Select[int]]] = {
    "dataset": _of_slug,
    "image_id": _of_image,
    "segment_id": _of_segment,
    "run_id": _of_run,
    "camera_id": _of_camera,
    "calibration_id": _of_calibration,
    "second_review_id": _of_second_review,
}


def _is_plain_id(value: str) -> bool:
    return value.isascii() and value.isdigit() and len(value) <= 10 and not value.startswith("0") and int(value) < 2**31


def _not_there(name: str, value: str) -> NotFound:
    """Return the error of a thing that never was."""
    if name == "dataset":
        return no_such_dataset(value)
    return NotFound(f"there is no {name.removesuffix('_id')} {value}")
