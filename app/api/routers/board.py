"""Leaderboards, as JSON and as CSV."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query, Response

from app.api.deps import Reader, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.base import RowId
from app.api.schemas.boards import BoardAnswer
from app.services.boards import board_csv, board_of
from app.services.splits import get_split

router = APIRouter(tags=["board"], responses=answers(404))
CSV = {200: {"content": {"text/csv": {"schema": {"type": "string"}}}}}
Protocol = Annotated[str, Query(max_length=60, description="The rank protocol.")]


@router.get("/splits/{split}/board")
def read_board(
    server: ServerDep,
    session: Reader,
    viewer: ViewerDep,
    split: str,
    version: RowId | None = None,
    protocol: Protocol = "clearlines-v2",
) -> BoardAnswer:
    """Return the board of a split: the best submission of each method, with intervals of numbers and ranks."""
    found = get_split(session, split)
    board = board_of(session, viewer, found, server.desk.boards, version=version, protocol=protocol)
    return BoardAnswer.model_validate(board)


@router.get("/splits/{split}/board.csv", response_class=Response, responses={**CSV})
def read_board_csv(
    server: ServerDep,
    session: Reader,
    viewer: ViewerDep,
    split: str,
    version: RowId | None = None,
    protocol: Protocol = "clearlines-v2",
) -> Response:
    """Return the board as CSV."""
    found = get_split(session, split)
    board = board_of(session, viewer, found, server.desk.boards, version=version, protocol=protocol)
    name = f"{found.slug}-v{board.version}-board.csv"
    headers = {"Content-Disposition": f'attachment; filename="{name}"'}
    return Response(board_csv(board), media_type="text/csv; charset=utf-8", headers=headers)
