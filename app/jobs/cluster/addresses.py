"""Addresses of schedulers, looked at before anything slow is imported."""

from __future__ import annotations

from importlib.util import find_spec
from urllib.parse import urlsplit

from app.errors import InvalidInput

SCHEMES = ("tcp", "tls")


def require_address(address: str) -> str:
    """Return the address of a scheduler.

    Raises:
        InvalidInput: When it can't be one.
    """
    parts = urlsplit(address)
    try:
        fine = parts.scheme in SCHEMES and bool(parts.hostname) and parts.port is not None and not parts.path.strip("/")
    except ValueError:  # a port that is no number
        fine = False
    if not fine:
        raise InvalidInput(
            f"{address!r:.100} is no address of a scheduler", where="cluster", expected="tcp://HOST:8786, or tls://"
        )
    return address


def require_cluster(address: str) -> str:
    """Return the address of a scheduler.

    Raises:
        InvalidInput: When it can't be one, or Dask isn't installed.
    """
    require_address(address)
    require_dask()
    return address


def require_dask() -> None:
    """Tell how Dask is installed where it isn't.

    Raises:
        InvalidInput: When it isn't.
    """
    if find_spec("distributed") is None:
        raise InvalidInput("Dask isn't installed", where="cluster", hint="pip install 'clearlines[cluster]'")
