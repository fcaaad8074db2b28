"""Files that somebody gave, read or explained."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.errors import InvalidFile, TooLarge
from app.formats.files import read_file


def test_a_file_is_read_up_to_its_limit(tmp_path: Path) -> None:
    path = tmp_path / "a.npz"
    path.write_bytes(b"12345")
    assert read_file(path, limit=5) == b"12345"
    with pytest.raises(TooLarge) as refused:
        read_file(path, limit=4, where="a.npz")
    assert refused.value.where == "a.npz"


@pytest.mark.parametrize("name", ["gone", "a_folder"])
def test_what_can_not_be_read_is_named_with_the_reason(tmp_path: Path, name: str) -> None:
    (tmp_path / "a_folder").mkdir()
    with pytest.raises(InvalidFile, match=r"can't be read: (No such|Is a)") as refused:
        read_file(tmp_path / name)
    assert refused.value.where == str(tmp_path / name)
