"""A provider: what it tells of itself, its keys, and codes exchanged for identity tokens."""

from __future__ import annotations

import base64
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, replace
from datetime import datetime
from typing import Any
from urllib.parse import quote, urlencode, urlsplit

import httpx2 as httpx
from joserfc.errors import JoseError
from joserfc.jwk import KeySet

from app.errors import InvalidInput, Unauthenticated, Unavailable
from app.openid.flow import Flow
from app.openid.id_token import ALGORITHMS, Expected, email_of, identified_by, name_of
from app.openid.identified import Identified

SECONDS = 10.0  # for each answer of the provider
GOOD_FOR = 3600.0  # s; for which what it tells of itself is kept
FAILED_FOR = 10.0  # s; for which it isn't asked again when it didn't answer
PATIENCE = 3.0  # s; for which others wait while it is asked
LONGEST = 2**20  # bytes of an answer
SCOPES = "openid profile email"


@dataclass(frozen=True)
class ClientRegistration:
    """What the provider knows this server as."""

    issuer: str
    client_id: str
    client_secret: str


class Provider:
    """One provider. Safe to use from several threads.

    Args:
        registration: Where it is, and who we are there.
        clock: Seconds, of a clock that doesn't jump.

    Raises:
        InvalidInput: When the issuer has no TLS, and isn't on this machine.
    """

    def __init__(self, registration: ClientRegistration, *, clock: Callable[[], float] = time.monotonic) -> None:
        self.registration = registration
        _require_tls(registration.issuer, "openid_issuer")
        self._clock = clock
        # redirects aren't followed: nobody but the provider is to be told secrets
        self._http = httpx.Client(timeout=SECONDS, follow_redirects=False)
        self._lock = threading.Lock()
        self._metadata: Mapping[str, Any] = {}
        self._keys: KeySet | None = None
        self._asked_at = float("-inf")
        self._failed_at = float("-inf")
        self._failure: Unavailable | None = None

    def close(self) -> None:
        """Close the connections."""
        self._http.close()

    def address_for(self, flow: Flow) -> str:
        """Return where the browser goes to be identified.

        Raises:
            Unavailable: When the provider doesn't answer, or not as one.
        """
        endpoint = str(self._known("authorization_endpoint"))
        question = {
            "response_type": "code",
            "client_id": self.registration.client_id,
            "redirect_uri": flow.redirect,
            "scope": SCOPES,
            "state": flow.state,
            "nonce": flow.nonce,
            "code_challenge": flow.challenge,
            "code_challenge_method": "S256",
        }
        return f"{endpoint}{'&' if urlsplit(endpoint).query else '?'}{urlencode(question)}"

    def identify(self, flow: Flow, code: str, now: datetime) -> Identified:
        """Exchange a code and return whom it is for.

        Raises:
            Unauthenticated: When the provider refuses the code, or its answer can't be trusted.
            Unavailable: When the provider doesn't answer, or not as one.
        """
        given = self._exchange(flow, code)
        offered = self._known("id_token_signing_alg_values_supported", ["RS256"])
        expected = Expected(
            self.registration.issuer,
            self.registration.client_id,
            flow.nonce,
            tuple(name for name in ALGORITHMS if name in offered),
        )
        found = self._verified(str(given["id_token"]), expected, now)
        if found.name is not None or not isinstance(given.get("access_token"), str):
            return found
        return self._described(found, given["access_token"])

    def _verified(self, text: str, expected: Expected, now: datetime) -> Identified:
        try:
            return identified_by(text, self._current_keys(), expected, now)
        except Unauthenticated as error:
            if not isinstance(error.__cause__, (JoseError, ValueError)):
                raise
        # providers change their keys, and the one that it is signed with may be new
        return identified_by(text, self._current_keys(anew=True), expected, now)

    def _described(self, found: Identified, access_token: str) -> Identified:
        """Return somebody with the name and email that providers may leave to a request of its own (section 5.3)."""
        endpoint = self._known("userinfo_endpoint", "")
        if not endpoint:
            return found
        response = self._asked("GET", str(endpoint), headers={"Authorization": f"Bearer {access_token}"})
        claims = _json_of(response) if response.status_code == 200 else {}
        if claims.get("sub") != found.subject:  # of somebody else, which section 5.3.2 warns of
            return found
        return replace(found, name=name_of(claims), email=email_of(claims))

    def _exchange(self, flow: Flow, code: str) -> Mapping[str, Any]:
        form = {
            "grant_type": "authorization_code",
            "code": code,
            "redirect_uri": flow.redirect,
            "code_verifier": flow.verifier,
        }
        ours, secret = quote(self.registration.client_id, safe=""), quote(self.registration.client_secret, safe="")
        headers = {"Accept": "application/json"}
        methods = self._known("token_endpoint_auth_methods_supported", ["client_secret_basic"])
        if "client_secret_basic" in methods:
            headers["Authorization"] = f"Basic {base64.b64encode(f'{ours}:{secret}'.encode()).decode()}"
        else:
            form |= {"client_id": self.registration.client_id, "client_secret": self.registration.client_secret}
        response = self._asked("POST", str(self._known("token_endpoint")), data=form, headers=headers)
        answer = _json_of(response)
        if 400 <= response.status_code < 500:
            raise Unauthenticated(
                "the provider doesn't accept the answer that it gave the browser",
                where=f"{answer.get('error', response.status_code)!s:.100}",
                hint="sign in once more",
            )
        if response.status_code != 200 or not isinstance(answer.get("id_token"), str):
            raise Unavailable("the provider gives no identity token", where=self.registration.issuer)
        return answer

    def _known(self, name: str, default: Any = None) -> Any:
        """Return what the provider tells of itself (OpenID Connect Discovery 1.0)."""
        with self._turn():
            if self._clock() - self._asked_at >= GOOD_FOR:
                self._metadata, self._keys, self._asked_at = self._described_by_itself(), None, self._clock()
            value = self._metadata.get(name, default)
        if value is None:
            raise Unavailable(f"the provider doesn't tell its {name}", where=self.registration.issuer)
        if (name.endswith("_endpoint") and value) or name == "jwks_uri":
            _require_tls(str(value), name)
        return value

    def _described_by_itself(self) -> Mapping[str, Any]:
        if self._failure is not None and self._clock() - self._failed_at < FAILED_FOR:
            raise self._failure.with_traceback(None)
        try:
            found = self._own_description()
        except Unavailable as error:
            self._failure, self._failed_at = error, self._clock()
            raise
        self._failure = None
        return found

    def _own_description(self) -> Mapping[str, Any]:
        found = self._read(f"{self.registration.issuer.rstrip('/')}/.well-known/openid-configuration")
        if found.get("issuer") != self.registration.issuer:
            raise Unavailable(
                "the provider calls itself otherwise",
                where=f"openid_issuer: {self.registration.issuer}",
                expected=f"{found.get('issuer')!s:.200}",
            )
        return found

    @contextmanager
    def _turn(self) -> Iterator[None]:
        """Let one thread ask; the others don't wait for long, or a provider that hangs would take all of them."""
        if not self._lock.acquire(timeout=PATIENCE):
            raise Unavailable(
                "the provider doesn't answer", where=self.registration.issuer, hint="try again in a moment"
            )
        try:
            yield
        finally:
            self._lock.release()

    def _current_keys(self, *, anew: bool = False) -> KeySet:
        address = str(self._known("jwks_uri"))
        with self._turn():
            if self._keys is None or anew:
                try:
                    self._keys = KeySet.import_key_set({"keys": self._read(address).get("keys", [])})
                except (JoseError, ValueError, TypeError) as error:
                    raise Unavailable("the provider's keys can't be read", where=address) from error
            return self._keys

    def _read(self, address: str) -> Mapping[str, Any]:
        response = self._asked("GET", address)
        if response.status_code != 200:
            raise Unavailable(f"the provider answers with {response.status_code}", where=address)
        return _json_of(response)

    def _asked(self, method: str, address: str, **how: Any) -> httpx.Response:
        try:
            with self._http.stream(method, address, **how) as response:
                content = b""
                for piece in response.iter_bytes():
                    content += piece
                    if len(content) > LONGEST:
                        raise Unavailable("the provider's answer doesn't end", where=address)
                return httpx.Response(response.status_code, content=content)
        except (httpx.HTTPError, httpx.InvalidURL, OSError) as error:
            raise Unavailable(
                f"the provider can't be reached: {type(error).__name__}", where=address, hint="try again in a moment"
            ) from error


def _json_of(response: httpx.Response) -> Mapping[str, Any]:
    try:
        answer = response.json()
    except ValueError:
        answer = None
    return answer if isinstance(answer, dict) else {}


def _require_tls(address: str, where: str) -> None:
    """Refuse addresses that others could read along or answer for.

    Raises:
        InvalidInput: When it has no TLS, and isn't on this machine.
    """
    parts = urlsplit(address)
    is_here = parts.hostname in {"localhost", "127.0.0.1", "::1"}
    if not (parts.scheme == "https" and parts.hostname) and not (parts.scheme == "http" and is_here):
        raise InvalidInput("the provider must be asked with TLS", where=f"{where}: {address:.200}", expected="https://")
