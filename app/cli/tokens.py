"""The commands ``token create``, ``token list`` and ``token revoke``."""

from __future__ import annotations

from typing import Annotated

import typer
from rich.console import Console

from app.cli.options import DataDir, settings_from
from app.cli.terminal import terminal

token_commands = typer.Typer(help="Names and roles under which people and programs ask a server.", no_args_is_help=True)


@token_commands.command("create")
def create_token(
    name: Annotated[str, typer.Argument(help="Of its holder; what they do is stored under it.")],
    role: Annotated[str, typer.Option(help="reader, submitter, annotator, maintainer or admin.")],
    expires: Annotated[float | None, typer.Option(metavar="DAYS", max=36_500, help="Good for so many days.")] = None,
    data: DataDir = None,
) -> None:
    """Make a token and print it, this once."""
    from app.commands.token import make_token

    token = make_token(settings_from(data_dir=data), name, role, days=expires)
    terminal.print(f"token of {token.name}, {token.role}; it is shown this once:", markup=False)
    typer.echo(token.text)


@token_commands.command("list")
def list_tokens(data: DataDir = None) -> None:
    """List names, roles and times of all tokens."""
    from app.commands.token import print_tokens

    print_tokens(settings_from(data_dir=data), Console(highlight=False, soft_wrap=True))


@token_commands.command("revoke")
def revoke_token(
    name: Annotated[str, typer.Argument(help="As the token was made with.")],
    data: DataDir = None,
) -> None:
    """End a token; what was done under its name stays."""
    from app.commands.token import end_token

    end_token(settings_from(data_dir=data), name)
    terminal.print(f"the token of {name} is revoked", markup=False)
