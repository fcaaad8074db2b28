"""Options that several commands take, and how they are read."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer

from app.commands.paths import require_folder_possible
from app.errors import InvalidInput

DataDir = Annotated[Path | None, typer.Option("--data", help="Folder of the database and the uploaded files.")]
Port = Annotated[int | None, typer.Option(min=0, max=65535, help="Port to listen on; 0 takes a free one.")]
NoBrowser = Annotated[bool, typer.Option("--no-browser", help="Don't open a browser.")]


def settings_from(**given: Any) -> Any:
    """Return the settings of the environment, with what was given on the command line.

    Args:
        given: Fields of ``Settings``; ``None`` means not given.

    Raises:
        InvalidInput: On a setting that can't be.
    """
    from pydantic import ValidationError

    from app.settings import Settings

    try:
        settings = Settings(**{name: value for name, value in given.items() if value is not None})
    except ValidationError as error:
        first = error.errors()[0]
        field = ".".join(map(str, first["loc"]))
        raise InvalidInput(first["msg"], where=f"setting {field}", hint=f"see CLEARLINES_{field.upper()}") from error
    require_folder_possible(settings.data_dir)
    return settings


def one_of(option: str, value: str, *allowed: str) -> Any:
    """Return an option's value.

    Raises:
        InvalidInput: When it is none of those allowed.
    """
    if value not in allowed:
        raise InvalidInput(f"{value!r} is not possible", where=option, expected=", ".join(allowed))
    return value
