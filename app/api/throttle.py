"""How often each account and each address may ask: requests, uploads, and failed sign-ins.

Counted in this process's memory: of several processes behind one proxy each counts for itself. Nobody is counted in
local mode.
"""

from __future__ import annotations

import ipaddress
import math
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass

from limits import RateLimitItem, parse_many
from limits.storage import MemoryStorage
from limits.strategies import MovingWindowRateLimiter, RateLimiter, SlidingWindowCounterRateLimiter
from starlette.types import Scope

from app.errors import InvalidInput, TooMany, Unauthenticated
from app.settings import Settings

RETRY_AFTER = "retry_after"
"""Key of a refusal's details: after how many seconds to try again; the answer says it in ``Retry-After`` too."""

NETWORK_BITS = 64
"""Of an address of version 6 that count: one customer usually has all addresses of such a network."""


@dataclass(frozen=True)
class Standing:
    """How one asker stands with one limit.

    Attributes:
        policy: Name of the limit.
        quota: How many are allowed within ``window``, in s.
        remaining: How many still are.
        reset: Until more are, in s.
    """

    policy: str
    quota: int
    window: int
    remaining: int
    reset: int

    def as_headers(self) -> dict[str, str]:
        """Return the fields of an answer (draft-ietf-httpapi-ratelimit-headers-10)."""
        return {
            "RateLimit-Policy": f'"{self.policy}";q={self.quota};w={self.window}',
            "RateLimit": f'"{self.policy}";r={self.remaining};t={self.reset}',
        }


class Limit:
    """One limit in the notation of `limits`: ``5/minute;30/hour`` allows five a minute and thirty an hour.

    Args:
        policy: Its name.
        notation: How often.
        strategy: Counts; used under this object's own lock.
        setting: The setting that it comes from.

    Raises:
        InvalidInput: When the notation can't be read.
    """

    def __init__(self, policy: str, notation: str, strategy: RateLimiter, setting: str) -> None:
        try:
            self._items: Sequence[RateLimitItem] = parse_many(notation)
        except ValueError as error:
            raise InvalidInput(
                "this is no limit", where=f"{setting}: {notation[:80]}", expected="like 5/minute;30/hour"
            ) from error
        self._policy = policy
        self._strategy = strategy
        self._in_flight: Counter[str] = Counter()
        self._lock = threading.Lock()

    def hit(self, key: str) -> Standing:
        """Count one, and return how the asker stands then.

        Raises:
            TooMany: When it is one too many; it isn't counted then.
        """
        with self._lock:
            self._require_left(key)
            for item in self._items:
                self._strategy.hit(item, self._policy, key)
            return min((self._standing(item, key) for item in self._items), key=lambda found: found.remaining)

    def require_left(self, key: str) -> None:
        """Refuse an asker who has none left; nothing is counted.

        Raises:
            TooMany: As `hit`.
        """
        with self._lock:
            self._require_left(key)

    @contextmanager
    def counting_failures(self, key: str) -> Iterator[None]:
        """Count what is done inside where it raises `Unauthenticated`; until it has ended it counts as failed.

        So of many guesses that are sent at once no more are looked at than of guesses sent one by one.

        Raises:
            TooMany: When there were too many failures already.
        """
        with self._lock:
            self._require_left(key)
            self._in_flight[key] += 1
        failed = False
        try:
            yield
        except Unauthenticated:
            failed = True
            raise
        finally:
            with self._lock:
                self._in_flight[key] -= 1
                if not self._in_flight[key]:
                    del self._in_flight[key]
                if failed:
                    for item in self._items:
                        self._strategy.hit(item, self._policy, key)

    def _require_left(self, key: str) -> None:
        for item in self._items:
            standing = self._standing(item, key)
            if standing.remaining <= self._in_flight[key]:
                raise TooMany(
                    f"too many {self._policy} in a short time",
                    expected=f"at most {standing.quota} in {standing.window} s",
                    hint=f"try again in {standing.reset} s",
                    details={RETRY_AFTER: standing.reset},
                )

    def _standing(self, item: RateLimitItem, key: str) -> Standing:
        stats = self._strategy.get_window_stats(item, self._policy, key)
        reset = max(1, math.ceil(stats.reset_time - time.time()))
        return Standing(self._policy, item.amount, item.get_expiry(), stats.remaining, reset)


class Throttle:
    """What a server counts.

    Args:
        settings: ``anonymous``, ``request_limit``, ``upload_limit``, ``sign_in_limit``.
        on_failure: Called for each failed sign-in.

    Raises:
        InvalidInput: When a limit can't be read.
    """

    def __init__(self, settings: Settings, *, on_failure: Callable[[], None] = lambda: None) -> None:
        self._on_failure = on_failure
        self.active = settings.anonymous != "admin"
        storage = MemoryStorage()
        window = SlidingWindowCounterRateLimiter(storage)
        self._requests = Limit("requests", settings.request_limit, window, "request_limit")
        self._refusals = Limit("refused requests", settings.request_limit, window, "request_limit")
        self._uploads = Limit("uploads", settings.upload_limit, window, "upload_limit")
        self._sign_ins = Limit(
            "failed sign-ins", settings.sign_in_limit, MovingWindowRateLimiter(storage), "sign_in_limit"
        )

    def request(self, asker: str) -> Standing | None:
        """Count a request; ``None`` where nothing is counted.

        Raises:
            TooMany: When it is one too many.
        """
        return self._requests.hit(asker) if self.active else None

    def upload(self, asker: str) -> Standing | None:
        """Count an upload; as `request`."""
        return self._uploads.hit(asker) if self.active else None

    def require_known(self, address: str) -> None:
        """Refuse an address that has sent too many tokens and sessions that aren't good.

        Raises:
            TooMany: When it has.
        """
        if self.active:
            self._refusals.require_left(address)

    def refused(self, address: str) -> None:
        """Count a request whose token or session isn't good."""
        if self.active:
            with suppress(TooMany):  # the next request is told
                self._refusals.hit(address)

    @contextmanager
    def signing_in(self, account: str | None, address: str, *, is_known: bool = False) -> Iterator[None]:
        """Look at a password, token or other secret inside; it counts as failed where that raises `Unauthenticated`.

        Args:
            account: The name that was given, known or not; ``None`` where the secret itself says who it is.
            address: From `client_address`.
            is_known: Whether the account was signed in to from there before. Such an address is counted apart, so that
                a stranger's guesses don't keep out whom they are about.

        Raises:
            TooMany: When too many have failed of that account or from that address; nothing is looked at then.
        """
        try:
            if not self.active:
                yield
                return
            with self._sign_ins.counting_failures(f"address {address}"):
                if account is None:
                    yield
                    return
                whose = f"account {account.casefold()}" + (f" from {address}" if is_known else "")
                with self._sign_ins.counting_failures(whose):
                    yield
        except Unauthenticated:
            self._on_failure()
            raise


def client_address(scope: Scope) -> str:
    """Return the address that asks, as the proxy tells it where there is one that is trusted; of version 6 the network.

    Args:
        scope: Of the request; ``request.scope``.
    """
    client = scope.get("client")
    if not client:
        return "unknown"
    try:
        address = ipaddress.ip_address(client[0].partition("%")[0])
    except ValueError:
        return str(client[0])[:100]
    if isinstance(address, ipaddress.IPv4Address):
        return str(address)
    if address.ipv4_mapped is not None:
        return str(address.ipv4_mapped)
    return str(ipaddress.ip_network((address, NETWORK_BITS), strict=False))
