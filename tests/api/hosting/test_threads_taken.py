"""A server all of whose threads wait, for a blob store that hangs for example, still says that it lives."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import pytest
from anyio.to_thread import current_default_thread_limiter
from fastapi.testclient import TestClient

PATIENCE = 30.0  # s


@pytest.fixture
def busy(hosted: TestClient) -> Iterator[TestClient]:
    """The hosted server without a thread that is free."""
    portal = hosted.portal
    assert portal is not None
    limiter = portal.call(current_default_thread_limiter)
    taken = [object() for _ in range(int(limiter.available_tokens))]
    for each in taken:
        portal.call(limiter.acquire_on_behalf_of_nowait, each)
    yield hosted
    for each in taken:
        portal.call(limiter.release_on_behalf_of, each)


@pytest.mark.parametrize("path", ["/api/health", "/api/ready"])
def test_it_lives_and_tells_it(busy: TestClient, path: str) -> None:
    pool = ThreadPoolExecutor(1)
    try:
        assert pool.submit(busy.get, path).result(PATIENCE).status_code == 200
    finally:
        pool.shutdown(wait=False)
