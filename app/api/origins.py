"""Under which names the server is asked, and which pages are its own."""

from __future__ import annotations

import ipaddress
from dataclasses import dataclass
from urllib.parse import urlsplit

from starlette.datastructures import Headers

from app.settings import Settings

LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "[::1]"})
DEFAULT_PORTS = {"http": 80, "https": 443}


@dataclass(frozen=True)
class OwnNames:
    """What the server is called.

    Attributes:
        names: Hosts that it answers for, without port; an address of version 6 has its brackets.
        numbers: Whether it answers for any address in numbers: no name resolves to it, so that DNS rebinding can't use
            it.
        public_origin: Of ``public_url``, where that is given.
        elsewhere: Origins of other sites whose pages may ask, with a token.
        has_accounts: Whether it may be asked through a proxy, since whoever asks isn't its owner.
    """

    names: frozenset[str] = LOOPBACK_NAMES
    numbers: bool = False
    public_origin: str | None = None
    elsewhere: frozenset[str] = frozenset()
    has_accounts: bool = False

    def has(self, host: str) -> bool:
        """Whether a Host header names this server."""
        name = host_name(host)
        return name in self.names or (self.numbers and _is_number(name))

    def is_own(self, origin: str, host: str) -> bool:
        """Whether a page of that origin is one of this server's, when it asks under that Host."""
        origin = origin.lower()
        if origin == self.public_origin:
            return True
        if self.public_origin is not None and host_name(host) == host_name(self.public_origin.partition("//")[2]):
            return False  # the same name without TLS is anybody's who is on the way
        return origin in {f"http://{host.lower()}", f"https://{host.lower()}"}

    def may_ask(self, origin: str, headers: Headers) -> bool:
        """Whether a page of another site may ask for a change: one that is allowed, and sends a token itself.

        What a browser adds by itself, a cookie, doesn't do: `app.api.gate` looks for none beside a token.
        """
        return origin.lower() in self.elsewhere and headers.get("authorization", "").lower().startswith("bearer ")


def own_names(settings: Settings) -> OwnNames:
    """Return what a server is called; in local mode by its loopback names alone."""
    if not settings.hosted:
        return OwnNames(has_accounts=settings.anonymous != "admin")
    names = {host_name(name) for name in settings.allowed_hosts}
    public = None
    if settings.public_url is not None:
        public = origin_of(settings.public_url)
        names.add(host_name(public.partition("//")[2]))
    elsewhere = frozenset(origin_of(origin) for origin in settings.cors_origins)
    return OwnNames(LOOPBACK_NAMES | names, True, public, elsewhere, has_accounts=True)


def origin_of(address: str) -> str:
    """Return the origin of an address as browsers send it: in lower case, without the port that goes without saying."""
    parts = urlsplit(address)
    host = parts.hostname or ""
    host = f"[{host}]" if ":" in host else host
    port = "" if parts.port in (None, DEFAULT_PORTS.get(parts.scheme)) else f":{parts.port}"
    return f"{parts.scheme}://{host}{port}"


def host_name(host: str) -> str:
    """Return the name of a Host header without its port; an IPv6 address keeps its brackets."""
    if host.startswith("["):
        return host.partition("]")[0].lower() + "]"
    return host.partition(":")[0].lower()


def _is_number(name: str) -> bool:
    try:
        ipaddress.ip_address(name.strip("[]"))
    except ValueError:
        return False
    return True
