"""Where a server listens: checked and taken before anything that is slow to import."""

from __future__ import annotations

import ipaddress
import socket

from app.errors import Forbidden, Unavailable

LOOPBACK_NAMES = frozenset({"localhost"})


def require_loopback(host: str) -> None:
    """Refuse addresses that others could reach: there are no accounts yet, and the one owner may do everything.

    Raises:
        Forbidden: When the address isn't a loopback one.
    """
    try:
        loopback = ipaddress.ip_address(host.strip("[]")).is_loopback
    except ValueError:
        loopback = host.lower() in LOOPBACK_NAMES
    if not loopback:
        raise Forbidden(
            "this address could be reached from outside, and there are no accounts yet",
            where=f"--host {host}",
            expected="127.0.0.1, ::1 or localhost",
            hint="from another machine, use an SSH tunnel: ssh -L 8765:127.0.0.1:8765 HOST",
        )


def listen(host: str, port: int) -> socket.socket:
    """Return a socket that listens on the address, which must be a loopback one.

    Raises:
        Forbidden: When others could reach the address.
        Unavailable: When it can't be had; most often because the port is taken.
    """
    require_loopback(host)
    family = socket.AF_INET6 if ":" in host else socket.AF_INET
    server = socket.socket(family, socket.SOCK_STREAM)
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
