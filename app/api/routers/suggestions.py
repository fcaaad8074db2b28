"""What a dataset's decisions suggest for the candidates that are left, and how good that is."""

from __future__ import annotations

from fastapi import APIRouter, status

from app.api.deps import Now, Reader, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.base import RowId
from app.api.schemas.suggestions import DatasetSuggestions, ImageSuggestions, TrainingState
from app.services import suggestion_reports, suggestions
from app.services.datasets import get_dataset
from app.services.suggestion_training import ask_for_training

router = APIRouter(tags=["suggestions"], responses=answers(404))


@router.get("/images/{image_id}/suggestions", responses=answers(503))
def read_image_suggestions(server: ServerDep, image_id: RowId) -> ImageSuggestions:
    """Return the probability that a person keeps each candidate, and why; nothing is decided by it.

    What isn't known of the candidates yet is computed first, which takes a moment on a large image.
    """
    known = server.features.features_of(image_id)  # without a session in hand: it may wait for a worker
    with server.database.read() as session:
        return ImageSuggestions.model_validate(suggestions.suggestions_of_image(session, image_id, known))


@router.get("/datasets/{slug}/suggestions")
def read_dataset_suggestions(session: Reader, slug: str) -> DatasetSuggestions:
    """Return a dataset's model: what it was learnt from, how good it is, and when the next one comes."""
    return DatasetSuggestions.model_validate(
        suggestion_reports.dataset_suggestions(session, get_dataset(session, slug))
    )


@router.post("/datasets/{slug}/suggestions/train", status_code=status.HTTP_202_ACCEPTED, responses=answers(409))
def train(server: ServerDep, viewer: ViewerDep, now: Now, slug: str) -> TrainingState:
    """Have a dataset's model learnt anew from all decisions so far; it takes some seconds, in the background.

    It happens by itself whenever the decisions have grown by a fifth.
    """
    with server.database.write() as session:
        dataset = get_dataset(session, slug)
        ask_for_training(session, dataset, now, person=viewer.name)
        session.flush()
        answer = TrainingState.model_validate(suggestion_reports.training_state(session, dataset))
    server.dispatcher.wake()
    return answer
