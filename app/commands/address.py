"""Where a server listens: checked and taken before anything that is slow to import."""

from __future__ import annotations

import socket

from app.errors import Forbidden, Unavailable
from app.settings import is_loopback


def require_loopback(host: str) -> None:
    """Refuse addresses that others could reach, for a server that has no accounts.

    Raises:
        Forbidden: When the address isn't a loopback one.
    """
    if not is_loopback(host):
        raise Forbidden(
            "this address could be reached from outside, and there are no accounts",
            where=f"--host {host}",
            expected="127.0.0.1, ::1 or localhost",
            hint="from another machine, use an SSH tunnel: ssh -L 8765:127.0.0.1:8765 HOST",
        )


def require_no_proxy(public_url: str | None) -> None:
    """Refuse to be served to others by a proxy, for a server that has no accounts.

    Raises:
        Forbidden: When it would be.
    """
    if public_url is not None:
        raise Forbidden(
            "others would reach it, and there are no accounts",
            where=f"CLEARLINES_PUBLIC_URL: {public_url}",
            hint="clearlines serve has them; leave the setting out for what is only shown on this machine",
        )


def listen(host: str, port: int, *, has_accounts: bool = False) -> socket.socket:
    """Return a socket that listens on the address, which must be a loopback one unless there are accounts.

    Args:
        host: A name or a number.
        port: 0 takes a free one.
        has_accounts: Whether others may reach it, see `app.commands.hosting.require_admin`.

    Raises:
        Forbidden: When others could reach the address, and there are no accounts.
        Unavailable: When it can't be had; most often because the port is taken.
    """
    if not has_accounts:
        require_loopback(host)
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    # asyncio sends without delay (TCP_NODELAY) where a socket says that its protocol is TCP: else each answer in two
    # pieces waits 40 ms for the acknowledgement of the first
    server = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        server.bind((host.strip("[]"), port))
        server.listen()
    except OSError as error:
        server.close()
        raise Unavailable(
            f"can't listen there: {error.strerror or error}",
            where=f"{host}:{port}",
            hint="is ClearLines running already? Another port: --port 0 takes a free one",
        ) from error
    return server


def address_of(server: socket.socket) -> str:
    """Return the address to open in a browser."""
    host, port = server.getsockname()[:2]
    return f"http://[{host}]:{port}" if ":" in host else f"http://{host}:{port}"
