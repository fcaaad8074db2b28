"""Files that appear whole or not at all, and places that are no files."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import pytest

from app.commands.whole_files import write_whole


def test_a_file_is_replaced_and_nothing_lies_beside_it(tmp_path: Path) -> None:
    place = tmp_path / "new" / "report.html"
    write_whole(place, b"first")
    write_whole(place, b"second")
    assert place.read_bytes() == b"second"
    assert [each.name for each in place.parent.iterdir()] == ["report.html"]


def test_a_link_stays_one(tmp_path: Path) -> None:
    (tmp_path / "there").write_bytes(b"old")
    link = tmp_path / "link"
    link.symlink_to("there")
    write_whole(link, b"new")
    assert link.is_symlink()
    assert (tmp_path / "there").read_bytes() == b"new"


def test_a_pipe_is_written_into(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    read: list[bytes] = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_bytes()), daemon=True)
    reader.start()
    write_whole(pipe, b"content")
    reader.join(10)
    assert read == [b"content"]
    assert pipe.is_fifo()


def test_what_the_process_has_open_is_written_into() -> None:
    read, write = os.pipe()
    try:
        write_whole(Path(f"/dev/fd/{write}"), b"content")
        assert os.read(read, 100) == b"content"
    finally:
        os.close(read)
        os.close(write)


def test_a_folder_is_no_place(tmp_path: Path) -> None:
    with pytest.raises(IsADirectoryError):
        write_whole(tmp_path, b"")
    assert list(tmp_path.iterdir()) == []
