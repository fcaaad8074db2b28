"""Flows are kept in a cookie of the browser that began them, sealed: any server that knows the secret can open them."""

from __future__ import annotations

import hmac
import json
from dataclasses import asdict
from datetime import datetime

from joserfc import jwe
from joserfc.errors import JoseError
from joserfc.jwk import OctKey

from app.openid.flow import Flow, not_begun

SEALING = {"alg": "dir", "enc": "A256GCM"}
LONGEST = 4000
"""Characters of a sealed flow; no browser keeps longer ones."""


def sealing_key(client_secret: str) -> OctKey:
    """Return the key that flows are sealed with: all servers that know the client's secret have the same one."""
    return OctKey.import_key(hmac.digest(client_secret.encode(), b"clearlines: flows of OpenID Connect", "sha256"))


def seal(flow: Flow, key: OctKey) -> str:
    """Return a flow as a text that nobody else can read or make."""
    return jwe.encrypt_compact(SEALING, json.dumps(asdict(flow)), key)


def unseal(text: str, key: OctKey, now: datetime) -> Flow:
    """Return the flow that was sealed.

    Raises:
        Unauthenticated: When it isn't one of ours, or is too old.
    """
    if not text or len(text) > LONGEST:
        raise not_begun()
    try:
        opened = jwe.decrypt_compact(text, key, algorithms=list(SEALING.values())).plaintext
        flow = Flow(**json.loads(opened or b"{}"))
    except (JoseError, ValueError, TypeError) as error:
        raise not_begun() from error
    if flow.expires <= now.timestamp():
        raise not_begun()
    return flow
