"""Which workers may work for which server."""

from __future__ import annotations

import pytest

from app.errors import InvalidInput
from app.jobs.cluster import addresses
from app.jobs.cluster.addresses import require_address, require_cluster
from app.jobs.cluster.versions import difference, installed_versions

OURS = {"clearlines": "1.2.0", "code": "1.2.0+kernels.aa", "python": "3.11.7", "numpy": "2.4.1", "opencv": "5.0.0"}


def test_a_worker_of_the_same_versions_may_work() -> None:
    assert difference(OURS, OURS) is None
    assert difference(installed_versions(), installed_versions()) is None
    # what can't change an answer doesn't matter
    assert difference(OURS, {**OURS, "python": "3.11.9", "numpy": "2.0.0", "opencv": "5.1.0"}) is None


@pytest.mark.parametrize(
    ("name", "version"),
    [
        ("clearlines", "1.2.1"),
        ("code", "1.2.0+kernels.bb"),
        ("python", "3.12.0"),
        ("numpy", "1.26.4"),
        ("opencv", "4.11.0"),
    ],
)
def test_a_worker_of_other_versions_may_not_and_is_told_which(name: str, version: str) -> None:
    reason = difference(OURS, {**OURS, name: version})
    assert reason == f"it runs {name} {version}; this server runs {name} {OURS[name]}"


def test_a_worker_that_does_not_tell_may_not() -> None:
    reason = difference(OURS, {"clearlines": "1.2.0"})
    assert reason is not None
    assert "code of an unknown version" in reason


def test_addresses_of_schedulers() -> None:
    for address in ("tcp://10.0.0.7:8786", "tls://scheduler.example.org:8786/", "tcp://[::1]:8786"):
        assert require_address(address) == address
    for address in ("", "scheduler:8786", "http://scheduler:8786", "tcp://scheduler", "tcp://:8786", "tcp://a:b"):
        with pytest.raises(InvalidInput, match="no address of a scheduler"):
            require_address(address)


def test_without_dask_it_is_told_how_to_install_it(monkeypatch: pytest.MonkeyPatch) -> None:
    assert require_cluster("tcp://127.0.0.1:8786") == "tcp://127.0.0.1:8786"
    monkeypatch.setattr(addresses, "find_spec", lambda name: None)
    with pytest.raises(InvalidInput, match="Dask isn't installed") as caught:
        require_cluster("tcp://127.0.0.1:8786")
    assert caught.value.hint == "pip install 'clearlines[cluster]'"
