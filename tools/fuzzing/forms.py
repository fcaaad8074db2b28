"""What is fuzzed lies inside something else: packed again after each change, or else a checksum would stop it."""

from __future__ import annotations

import gzip
import io
import struct
import tarfile
import zipfile
import zlib
from collections.abc import Callable

Form = Callable[[bytes], bytes]
PNG_SIGNATURE = b"\x89PNG\r\n\x1a\n"


def as_it_is(content: bytes) -> bytes:
    """Return the content."""
    return content


def zip_member(name: str) -> Form:
    """Return what makes content the one member of a zip."""

    def form(content: bytes) -> bytes:
        stream = io.BytesIO()
        with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.writestr(zipfile.ZipInfo(name), content)
        return stream.getvalue()

    return form


def npz_member(name: str, others: dict[str, bytes]) -> Form:
    """Return what makes content one array of a npz beside others."""

    def form(content: bytes) -> bytes:
        stream = io.BytesIO()
        with zipfile.ZipFile(stream, "w") as archive:
            for member, data in {**others, name: content}.items():
                archive.writestr(zipfile.ZipInfo(f"{member}.npy"), data)
        return stream.getvalue()

    return form


def tar_member(name: str) -> Form:
    """Return what makes content the one member of a tar.gz."""

    def form(content: bytes) -> bytes:
        stream = io.BytesIO()
        with tarfile.open(fileobj=stream, mode="w") as archive:
            info = tarfile.TarInfo(name)
            info.size = len(content)
            archive.addfile(info, io.BytesIO(content))
        return gzipped(stream.getvalue())

    return form


def gzipped(content: bytes) -> bytes:
    """Return content packed with gzip."""
    return gzip.compress(content, 1, mtime=0)


def png_with_sums(content: bytes) -> bytes:
    """Return a PNG whose chunks have the checksums that their content needs (ISO/IEC 15948, 5.3)."""
    parts, at = [content[: len(PNG_SIGNATURE)]], len(PNG_SIGNATURE)
    while at + 12 <= len(content):
        (length,) = struct.unpack_from(">I", content, at)
        chunk = content[at + 4 : at + 8 + length]
        parts.append(content[at : at + 4] + chunk + struct.pack(">I", zlib.crc32(chunk)))
        at += 12 + length
    return b"".join([*parts, content[at:]])
