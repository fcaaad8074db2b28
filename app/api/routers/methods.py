"""Methods: what authors call their detectors."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter
from sqlalchemy.orm import Session

from app.api.deps import Now, Reader, ServerDep, ViewerDep
from app.api.problems import answers
from app.api.schemas.methods import MethodAnswer, MethodChange
from app.db.models import Method
from app.services import methods
from app.services.access import Viewer
from app.services.submission_lists import submissions_of_method

router = APIRouter(tags=["methods"], responses=answers(404))


@router.get("/methods/{method}")
def read_method(session: Reader, viewer: ViewerDep, method: str) -> MethodAnswer:
    """Return a method with all of its submissions that one may see, newest first."""
    return _answer(session, viewer, methods.get_method(session, viewer, method))


@router.patch("/methods/{method}", responses=answers(409))
def change_method(server: ServerDep, viewer: ViewerDep, now: Now, method: str, given: MethodChange) -> MethodAnswer:
    """Change what is said of a method; `anonymous: false` reveals whose it is, for good."""
    named = {name: getattr(given, name) for name in given.model_fields_set}
    kept = ("name", "anonymous")
    changes: dict[str, Any] = {name: value for name, value in named.items() if value is not None or name not in kept}
    with server.database.write() as session:
        changed = methods.change_method(session, viewer, method, methods.MethodChanges(**changes), now)
        return _answer(session, viewer, changed)


def _answer(session: Session, viewer: Viewer, method: Method) -> MethodAnswer:
    view = methods.method_view(viewer, method)
    return MethodAnswer.model_validate({**vars(view), "submissions": submissions_of_method(session, viewer, method)})
