"""A dataset's card."""

from __future__ import annotations

from pydantic import ConfigDict, Field

from app.api.schemas.base import Answer, VerdictCounts


class CardSource(Answer):
    """Images of one origin."""

    source: str | None
    images: int
    labelled: int = Field(description="Images whose review is done.")
    sequences: int
    cameras: int
    sizes: list[str] = Field(description="Widths and heights that occur, the most frequent first: `1242 x 375`.")


class TableOneRow(Answer):
    """How well the candidates did against the labels that were made of them, over one source's labelled images."""

    source: str | None = Field(description="Null for images without one; the last row, `all`, has every image.")
    images: int
    precision: float | None = Field(description="Null where it isn't defined.")
    recall: float | None
    f1: float | None
    f1_v2: float | None = Field(description="Under clearlines-v2; precision, recall and F1 are under official-v1.")


class Card(Answer):
    """What a dataset holds, how well the pipeline did on it, and how to cite it."""

    model_config = ConfigDict(
        json_schema_extra={
            "example": {
                "slug": "downtown-spring",
                "name": "Downtown, spring",
                "description": "Two drives through the city",
                "licence": "CC BY 4.0",
                "citation": None,
                "images": 85,
                "labelled": 85,
                "sources": [
                    {
                        "source": "KITTI",
                        "images": 85,
                        "labelled": 85,
                        "sequences": 4,
                        "cameras": 2,
                        "sizes": ["1242 x 375", "1224 x 370"],
                    }
                ],
                "labels": 2210,
                "verdicts": {"keep": 2210, "reject": 9034, "ambiguous": 31, "undecided": 0},
                "table_one": [
                    {"source": "KITTI", "images": 85, "precision": 0.43, "recall": 0.91, "f1": 0.58, "f1_v2": 0.55}
                ],
                "figure": "/api/datasets/downtown-spring/card.png",
            }
        }
    )

    slug: str
    name: str
    description: str | None
    licence: str | None
    citation: str | None
    images: int
    labelled: int = Field(description="Images whose review is done.")
    sources: list[CardSource]
    labels: int = Field(description="Kept segments.")
    verdicts: VerdictCounts
    table_one: list[TableOneRow] = Field(description="Empty while no image is done.")
    figure: str | None = Field(description="Address of the picture: image, candidates, kept; null without labels.")
