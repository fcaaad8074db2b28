"""What tells one build of the detector from another."""

import hashlib
import re
from pathlib import Path

import pytest

from app import __version__
from app.errors import BrokenInstallation
from app.vision import code_version as module
from app.vision.native import library


def test_it_is_the_version_and_a_hash_of_the_kernels() -> None:
    version, _, kernels = module.code_version().rpartition("kernels.")
    assert version in (f"{__version__}+", f"{__version__}.")
    assert re.fullmatch("[0-9a-f]{8}", kernels)
    assert library.kernels_hash().startswith(kernels)


def test_a_version_that_is_local_already_stays_a_version(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "__version__", "0+unknown")
    assert module.code_version().startswith("0+unknown.kernels.")


def test_other_kernels_have_another_hash(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "kernels.so"
    monkeypatch.setenv("CLEARLINES_KERNELS", str(path))
    with pytest.raises(BrokenInstallation, match="kernels can't be used") as caught:
        library.kernels_hash.__wrapped__()
    assert caught.value.where == str(path)
    path.write_bytes(b"others")
    assert library.kernels_hash.__wrapped__() == hashlib.sha256(b"others").hexdigest()
