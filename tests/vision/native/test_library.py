"""Loading of the kernels, and records that agree with C's."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from app.errors import BrokenInstallation
from app.vision.native import library as module
from app.vision.native.records import (
    ARC,
    CACHE_LINE,
    FINDING,
    JOIN,
    LINES_BEYOND,
    MARGIN,
    POINT,
    SPAN,
    SPAN_PIXELS,
    SURFACE,
    Scene,
    address,
    aligned,
)

NATIVE = Path(module.__file__).parent
SIZES = {"int32_t": 4, "uint32_t": 4, "float": 4, "double": 8}


def declared(source: str, name: str) -> list[tuple[str, int]]:
    """Fields of a C record with their sizes in bytes, arrays whole."""
    text = (NATIVE / source).read_text()
    constants = {"MOMENTS": 9, "TRAITS": 3}
    (body,) = re.findall(rf"typedef struct \{{([^{{}}]*)\}} {name};", text)
    fields = []
    for kind, names in re.findall(
        r"(u?int32_t|float|double) ([^;]+);", re.sub(r"/\*.*?\*/", "", body, flags=re.DOTALL)
    ):
        for field in names.split(","):
            base, _, count = field.strip().rstrip("]").partition("[")
            fields.append((base, SIZES[kind] * int(constants.get(count, count) or 1)))
    return fields


@pytest.mark.parametrize(
    ("record", "source", "name"),
    [
        (POINT, "kernels.h", "EdgePoint"),
        (SPAN, "kernels.h", "Span"),
        (ARC, "kernels.h", "Arc"),
        (FINDING, "selection.c", "Finding"),
        (SURFACE, "painting.h", "Surface"),
    ],
)
def test_a_record_has_the_fields_of_its_declaration(record: np.dtype, source: str, name: str) -> None:
    assert [(field, record[field].itemsize) for field in record.names or ()] == declared(source, name)


def test_a_join_has_the_size_of_its_declaration() -> None:
    # its two ends are four numbers there
    assert sum(size for _, size in declared("merging.c", "Join")) == JOIN.itemsize


def test_the_scene_has_the_order_of_its_declaration() -> None:
    (body,) = re.findall(r"typedef struct \{([^{}]*)\} Scene;", (NATIVE / "kernels.h").read_text())
    names = re.findall(r"(\w+)(?:\[2\])?(?:,|;)", re.sub(r"/\*.*?\*/", "", body))
    assert names == [field[0] for field in Scene._fields_]


def test_lines_have_the_margins_of_their_declaration() -> None:
    declared_sizes = re.findall(r"(MARGIN|LINES_BEYOND|SPAN_PIXELS) = (\d+)", (NATIVE / "places.h").read_text())
    numbers = {"MARGIN": MARGIN, "LINES_BEYOND": LINES_BEYOND, "SPAN_PIXELS": SPAN_PIXELS}
    assert {name: int(number) for name, number in declared_sizes} == numbers


def test_aligned_records_begin_where_cache_lines_do() -> None:
    for count in (1, 2, 5):
        arcs = aligned(count, ARC)
        assert arcs.shape == (count,)
        assert address(arcs) % CACHE_LINE == 0


def test_only_contiguous_memory_has_an_address() -> None:
    image = np.zeros((4, 6), np.uint8)
    assert address(image) == image.ctypes.data
    with pytest.raises(ValueError, match="contiguous"):
        address(image[:, ::2])


@pytest.mark.parametrize("content", [None, b"no library"])
def test_a_library_that_cannot_be_loaded_is_a_broken_installation(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, content: bytes | None
) -> None:
    path = tmp_path / "kernels.so"
    if content is not None:
        path.write_bytes(content)
    monkeypatch.setenv("CLEARLINES_KERNELS", str(path))
    with pytest.raises(BrokenInstallation, match="kernels can't be used") as caught:
        module.kernels.__wrapped__()
    assert caught.value.where == str(path)
    assert "CLEARLINES_KERNELS" in (caught.value.hint or "")


def test_a_copy_of_the_project_is_told_how_to_build_them() -> None:
    program = (
        "import app.vision.native.library as library; library._SUFFIX = '.missing'\n"
        "import numpy, app.vision\n"
        "app.vision.detect(numpy.zeros((9, 9), numpy.uint8))"
    )
    environment = {name: value for name, value in os.environ.items() if name != "CLEARLINES_KERNELS"}
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=environment)
    assert done.returncode != 0
    assert "BrokenInstallation" in done.stderr
    assert "python build_native.py" in done.stderr
