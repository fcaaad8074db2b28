"""Send a webhook to an address that a stranger gave, without being made to talk to what only this machine reaches.

The name is resolved once, every address it has must be public, and the request goes to that very address: a name that
resolves to something else a moment later changes nothing. Redirects aren't followed, and the answer's body isn't read.
"""

from __future__ import annotations

import ipaddress
import socket
from typing import Any
from urllib.parse import SplitResult, urlsplit

import httpx2 as httpx

from app.errors import InvalidInput, Unavailable

SCHEMES = {"http": 80, "https": 443}
LONGEST = 2_000


def check_webhook_url(url: str) -> SplitResult:
    """Return the parts of a webhook's address; nothing is resolved yet.

    Raises:
        InvalidInput: When it is no http or https address, or holds a password.
    """
    expected = "https://HOST/PATH"
    try:
        parts = urlsplit(url)
        port = parts.port
    except ValueError as error:
        raise InvalidInput("this is no address", where="webhook_url", expected=expected) from error
    if len(url) > LONGEST or not url.isascii() or any(character <= " " for character in url):
        raise InvalidInput("the address is too long or holds odd characters", where="webhook_url", expected=expected)
    if parts.scheme not in SCHEMES or not parts.hostname or port == 0:
        raise InvalidInput("this is no web address", where="webhook_url", expected=expected)
    if parts.username is not None or parts.password is not None:
        raise InvalidInput("the address holds a password", where="webhook_url", expected=expected)
    return parts


def send_webhook(url: str, content: dict[str, Any], *, seconds: float, allow_private: bool) -> int:
    """Post JSON to an address and return the status of the answer.

    Args:
        url: Where to.
        content: JSON-serialisable.
        seconds: For resolving aside: connecting, sending, and waiting for the answer, each.
        allow_private: Whether addresses that aren't public are allowed.

    Raises:
        InvalidInput: When the address is none, or not a public one.
        Unavailable: When nobody answers there.
    """
    parts = check_webhook_url(url)
    host, port = parts.hostname or "", parts.port or SCHEMES[parts.scheme]
    address = _resolved(host, port, allow_private=allow_private)
    literal = f"[{address}]" if ":" in address else address
    target = parts._replace(netloc=f"{literal}:{port}", fragment="").geturl()
    named = f"[{host}]" if ":" in host else host
    headers = {"Host": named if port == SCHEMES[parts.scheme] else f"{named}:{port}", "User-Agent": "ClearLines"}
    try:
        # trust_env: a proxy from the environment would resolve the name once more
        with (
            httpx.Client(timeout=seconds, follow_redirects=False, trust_env=False) as client,
            client.stream("POST", target, json=content, headers=headers, extensions={"sni_hostname": host}) as response,
        ):
            return response.status_code
    except (httpx.HTTPError, httpx.InvalidURL, OSError) as error:
        raise Unavailable(f"no answer: {type(error).__name__}", where=host) from error


def _resolved(host: str, port: int, *, allow_private: bool) -> str:
    try:
        found = socket.getaddrinfo(host, port, type=socket.SOCK_STREAM)
    except (OSError, UnicodeError) as error:
        raise Unavailable("the name can't be resolved", where=host) from error
    addresses = [str(entry[4][0]) for entry in found]
    if not allow_private and not all(_is_public(address) for address in addresses):
        raise InvalidInput(
            "the address isn't a public one",
            where="webhook_url",
            hint="CLEARLINES_WEBHOOK_PRIVATE_ADDRESSES allows others",
        )
    return addresses[0]


def _is_public(address: str) -> bool:
    """Whether an address is reachable from everywhere, in whatever form it is written."""
    parsed = ipaddress.ip_address(address.partition("%")[0])
    if isinstance(parsed, ipaddress.IPv6Address):
        inner = parsed.ipv4_mapped or parsed.sixtofour or (parsed.teredo or (None, None))[1]
        if inner is not None:
            return inner.is_global and not inner.is_multicast
        if parsed in ipaddress.ip_network("64:ff9b::/96"):  # NAT64: the last four bytes are an IPv4 address
            return _is_public(str(ipaddress.IPv4Address(int(parsed) & 0xFFFFFFFF)))
    return parsed.is_global and not parsed.is_multicast
