"""Where a server listens: on this machine alone, on a port that is free."""

from __future__ import annotations

import asyncio
import socket

import pytest

from app.commands.address import address_of, listen
from app.errors import Forbidden, Unavailable
from tests.event_loop import run


@pytest.mark.parametrize("host", ["0.0.0.0", "::", "", "192.168.1.4", "example.org", "127.0.0.1.example.org", "[::]"])
def test_an_address_that_others_reach_is_refused_before_it_is_listened_on(host: str) -> None:
    with pytest.raises(Forbidden, match="no accounts"):
        listen(host, 0)


@pytest.mark.parametrize("host", ["127.0.0.1", "localhost", "LOCALHOST", "127.0.0.2"])
def test_port_zero_takes_a_free_one_and_the_address_says_which(host: str) -> None:
    with listen(host, 0) as server:
        port = server.getsockname()[1]
        assert port > 0
        assert address_of(server).endswith(f":{port}")
        with socket.create_connection(server.getsockname()):
            pass


@pytest.mark.parametrize("host", ["::1", "[::1]"])
def test_an_address_of_version_6_is_bracketed(host: str) -> None:
    if not socket.has_ipv6:
        pytest.skip("this machine has no IPv6")
    with listen(host, 0) as server:
        assert address_of(server) == f"http://[::1]:{server.getsockname()[1]}"


def test_a_port_that_is_taken_is_told_with_what_to_do() -> None:
    with listen("127.0.0.1", 0) as first, pytest.raises(Unavailable) as refused:
        listen("127.0.0.1", first.getsockname()[1])
    assert "in use" in refused.value.message
    assert "--port 0" in str(refused.value.hint)


def test_where_there_are_accounts_others_may_reach_it() -> None:
    with listen("0.0.0.0", 0, has_accounts=True) as server:
        assert address_of(server) == f"http://0.0.0.0:{server.getsockname()[1]}"


def test_answers_are_sent_without_delay() -> None:
    async def delayed() -> int:
        accepted: asyncio.Future[int] = asyncio.get_running_loop().create_future()

        def connected(_reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            accepted.set_result(writer.get_extra_info("socket").getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY))
            writer.close()

        listening = listen("127.0.0.1", 0)
        async with await asyncio.start_server(connected, sock=listening):
            _, writer = await asyncio.open_connection(*listening.getsockname())
            without_delay = await accepted
            writer.close()
            await writer.wait_closed()
        return without_delay

    assert run(delayed()) != 0
