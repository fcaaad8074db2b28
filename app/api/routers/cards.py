"""A dataset's card: what it holds, how well the pipeline did on it, and under which licence it is."""

from __future__ import annotations

from dataclasses import asdict

from fastapi import APIRouter, Response

from app.api.deps import Now, Reader, ServerDep
from app.api.problems import answers
from app.api.schemas.cards import Card
from app.evaluation.table_one import TableRow
from app.services import cards
from app.services.card_tables import table_content
from app.services.datasets import get_dataset
from app.services.remembering import is_large

router = APIRouter(prefix="/datasets/{slug}", tags=["datasets"], responses=answers(404))
PNG = {200: {"content": {"image/png": {"schema": {"type": "string", "format": "binary"}}}}}


@router.get("/card")
def read_card(server: ServerDep, now: Now, session: Reader, slug: str) -> Card:
    """Return a dataset's card; the scores of its candidates take a while the first time after labels have changed.

    They are of at most 300 images, spread evenly over those that are done. Of a dataset of more than 2,000 images they
    are computed once a minute at most.
    """
    dataset = get_dataset(session, slug)
    card = asdict(cards.dataset_card(session, slug))
    large = is_large(session, dataset)
    session.close()  # given back before the scores are computed

    def compute() -> tuple[TableRow, ...]:
        return server.card_tables.table_of(slug)

    table = server.remembered.get(("table one", dataset.id), now, compute) if large else compute()
    return Card.model_validate({**card, "table_one": table_content(table)})


@router.get("/card.png", response_class=Response, responses={**PNG})
def read_card_figure(server: ServerDep, session: Reader, slug: str) -> Response:
    """Return the card's figure: an image, its candidates, and what was kept of them."""
    picture = cards.card_figure(session, server.blobs, slug, max_pixels=server.settings.max_image_pixels)
    return Response(picture, media_type="image/png", headers={"Cache-Control": "private, no-cache"})
