"""The commands ``user create``, ``list``, ``role``, ``disable``, ``enable``, ``reset`` and ``invite``."""

from __future__ import annotations

import sys
from typing import Annotated, Any

import typer
from rich.console import Console

from app.cli.options import DataDir, settings_from
from app.cli.terminal import terminal
from app.errors import InvalidInput

user_commands = typer.Typer(help="Accounts of the people who sign in to a server.", no_args_is_help=True)
Name = Annotated[str, typer.Argument(help="Of the account.")]
RoleOption = Annotated[str, typer.Option(help="reader, submitter, annotator, maintainer or admin.")]
LONGEST_LINE = 4_000  # characters


@user_commands.command("create")
def create_user(
    name: Annotated[str, typer.Argument(help="What they do is stored under it, so it is never given twice.")],
    role: RoleOption,
    email: Annotated[str | None, typer.Option(help="Where they can be reached; only they and admins see it.")] = None,
    password_stdin: Annotated[
        bool, typer.Option("--password-stdin", help="Read the password's line from there.")
    ] = False,
    invite: Annotated[bool, typer.Option("--invite", help="Print a link by which they choose a password.")] = False,
    data: DataDir = None,
) -> None:
    """Make an account; asks for its password twice."""
    from app.commands.user import make_user, make_user_with_link, require_possible

    if invite and password_stdin:
        raise InvalidInput("either they choose a password or you do", where="--invite, --password-stdin")
    settings = settings_from(data_dir=data)
    require_possible(settings, name, role, email)
    if invite:
        user, link = make_user_with_link(settings, name, role, email=email)
        _tell_link(f"account of {user.name}, {user.role}; by this link, once, they choose a password:", link)
        return
    user = make_user(settings, name, role, email=email, password=_password(from_stdin=password_stdin))
    terminal.print(f"account of {user.name}, {user.role}", markup=False)


@user_commands.command("list")
def list_users(data: DataDir = None) -> None:
    """List names, roles and times of all accounts."""
    from app.commands.user import print_users

    print_users(settings_from(data_dir=data), Console(highlight=False, soft_wrap=True))


@user_commands.command("role")
def give_role(
    name: Name,
    role: Annotated[str, typer.Argument(help="reader, submitter, annotator, maintainer or admin.")],
    data: DataDir = None,
) -> None:
    """Give an account another role, from its next request on."""
    from app.commands import user

    user.give_role(settings_from(data_dir=data), name, role)
    terminal.print(f"{name} is {role}", markup=False)


@user_commands.command("disable")
def disable_user(name: Name, data: DataDir = None) -> None:
    """Shut an account: its sessions, tokens and links end at once; what was done under its name stays."""
    from app.commands.user import switch_user

    switch_user(settings_from(data_dir=data), name, disabled=True)
    terminal.print(f"{name} is disabled", markup=False)


@user_commands.command("enable")
def enable_user(name: Name, data: DataDir = None) -> None:
    """Open an account again; its holder signs in anew."""
    from app.commands.user import switch_user

    switch_user(settings_from(data_dir=data), name, disabled=False)
    terminal.print(f"{name} is enabled", markup=False)


@user_commands.command("reset")
def reset_password(name: Name, data: DataDir = None) -> None:
    """Print a link by which somebody chooses a new password, once."""
    from app.commands.user import make_reset_link

    link = make_reset_link(settings_from(data_dir=data), name)
    _tell_link(f"by this link, once, {name} chooses a password:", link)


@user_commands.command("invite")
def invite_user(
    role: RoleOption,
    name: Annotated[str | None, typer.Option(help="Of the account; they choose one when left out.")] = None,
    days: Annotated[float | None, typer.Option(max=366, help="How long the link is good.")] = None,
    data: DataDir = None,
) -> None:
    """Print a link that makes an account, once."""
    from app.commands.user import make_invitation

    link = make_invitation(settings_from(data_dir=data), role, name=name, days=days)
    _tell_link(f"by this link, once, somebody makes an account, {role}:", link)


def _tell_link(text: str, link: str) -> None:
    terminal.print(text, markup=False)
    typer.echo(link)


def _password(*, from_stdin: bool) -> Any:
    if from_stdin:
        return sys.stdin.readline(LONGEST_LINE).removesuffix("\n").removesuffix("\r")
    return typer.prompt("Password", hide_input=True, confirmation_prompt="Again", err=True)
