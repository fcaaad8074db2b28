"""The kernels' library: when it is compiled, with what, and what is said when that fails."""

from __future__ import annotations

import ctypes
import importlib.util
import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from build_native import (
    COMPILERS,
    NATIVE,
    ZIGLANG,
    CompileError,
    build_library,
    compile_command,
    find_compiler,
    is_zig,
    library_name,
)

ROOT = Path(__file__).resolve().parent.parent.parent
SOURCE = """
#include "scale.h"
__attribute__((visibility("default"))) int scaled(int value) { return SCALE * value; }
__attribute__((visibility("default"))) double multiply_add(double a, double b, double c) { return a * b + c; }
int internal(void) { return 1; }
"""
WHEEL_PROGRAM = [sys.executable, "-m", "ziglang", "cc"]
REQUIREMENTS = """
import hatchling.build as build
print(build.get_requires_for_build_wheel(), build.get_requires_for_build_editable(), sep="\\n")
print(build.get_requires_for_build_sdist())
"""
needs_compiler = pytest.mark.skipif(find_compiler(os.environ) is None, reason="no C compiler on this machine")
no_wheel = pytest.mark.skipif(importlib.util.find_spec("ziglang") is not None, reason="the wheel is a compiler")
posix = pytest.mark.skipif(os.name != "posix", reason="writes shell scripts")


@pytest.fixture
def project(tmp_path: Path) -> Path:
    """A project with one small kernel."""
    folder = tmp_path / NATIVE
    folder.mkdir(parents=True)
    (folder / "scale.c").write_text(SOURCE)
    (folder / "scale.h").write_text("#ifndef SCALE\n#define SCALE 2\n#endif\n")
    return tmp_path


def program(path: Path, script: str) -> Path:
    path.parent.mkdir(exist_ok=True)
    path.write_text(f"#!/bin/sh\n{script}\n")
    path.chmod(0o755)
    return path


def bare(**variables: str) -> dict[str, str]:
    """The environment without a compiler in it."""
    return {**{name: value for name, value in os.environ.items() if name not in {"CC", "PATH"}}, **variables}


def test_this_installation_has_its_library() -> None:
    assert (ROOT / NATIVE / library_name()).is_file()


@needs_compiler
def test_the_library_exports_what_it_says_and_computes_in_separate_operations(project: Path) -> None:
    library = ctypes.CDLL(str(build_library(project)))
    assert library.scaled(21) == 42
    assert not hasattr(library, "internal")
    library.multiply_add.restype = ctypes.c_double
    library.multiply_add.argtypes = [ctypes.c_double] * 3
    step = 2.0**-27
    # the exact product has a bit of 2^-54 that rounding drops, and that a fused operation would keep
    assert library.multiply_add(1 + step, 1 + step, -(1 + 2 * step)) == 0.0


@needs_compiler
def test_it_is_compiled_again_only_when_sources_or_flags_change(project: Path) -> None:
    library = build_library(project)
    first = library.stat()
    assert build_library(project).stat().st_mtime_ns == first.st_mtime_ns
    header = project / NATIVE / "scale.h"
    header.write_text(header.read_text().replace("2", "3"))
    # set back, as a checkout of an older revision may: it is the content that counts
    os.utime(header, (0, 0))
    assert build_library(project).stat().st_mtime_ns != first.st_mtime_ns
    assert ctypes.CDLL(str(library)).scaled(2) == 6
    other = project / "other" / library_name()
    assert build_library(project, output=other, flags=["-DSCALE=5"]) == other
    assert ctypes.CDLL(str(other)).scaled(2) == 10
    second = other.stat()
    assert build_library(project, output=other, flags=["-DSCALE=7"]).stat().st_mtime_ns != second.st_mtime_ns


@needs_compiler
def test_a_failure_says_the_command_what_the_compiler_said_and_what_helps(project: Path) -> None:
    library = build_library(project)
    before = library.read_bytes()
    (project / NATIVE / "scale.c").write_text("int scaled(int value) { return value }\n")
    with pytest.raises(CompileError) as failure:
        build_library(project)
    message = str(failure.value)
    assert "-ffp-contract=off" in message
    assert "scale.c:1" in message
    assert ZIGLANG in message
    assert library.read_bytes() == before
    assert {path.name for path in library.parent.iterdir()} == {
        *("scale.c", "scale.h", library.name, library.with_suffix(".stamp").name)
    }


def test_a_compiler_that_is_named_and_not_there_is_not_replaced_by_another(project: Path) -> None:
    with pytest.raises(CompileError, match="no-such-compiler"):
        build_library(project, environment={**os.environ, "CC": "no-such-compiler --fast"})


@needs_compiler
@no_wheel
def test_without_a_compiler_a_library_of_these_sources_will_do_and_no_other(project: Path) -> None:
    library = build_library(project)
    assert build_library(project, environment={}) == library
    (project / NATIVE / "scale.h").write_text("#define SCALE 9\n")
    with pytest.raises(CompileError, match="no C compiler"):
        build_library(project, environment={})


def test_sources_that_are_missing_are_told(tmp_path: Path) -> None:
    with pytest.raises(CompileError, match="no C sources"):
        build_library(tmp_path)


def test_without_a_compiler_only_the_wheel_helps(tmp_path: Path) -> None:
    wheel = WHEEL_PROGRAM if importlib.util.find_spec("ziglang") else None
    assert find_compiler({"PATH": str(tmp_path)}) == wheel
    assert find_compiler({}) == wheel


@posix
@needs_compiler
def test_a_compiler_without_headers_is_passed_over(tmp_path: Path) -> None:
    working = find_compiler(os.environ)
    assert working is not None
    program(tmp_path / "bin" / COMPILERS[0], "echo 'math.h: No such file' >&2; exit 1")
    sound = program(tmp_path / "bin" / COMPILERS[1], f'exec {shlex.join(working)} "$@"')
    assert find_compiler(bare(PATH=f"{tmp_path / 'bin'}{os.pathsep}{os.environ['PATH']}")) == [str(sound)]


@pytest.mark.parametrize(
    ("compiler", "answer"),
    [
        (["zig", "cc"], True),
        (["/opt/zig/zig", "cc"], True),
        (["python-zig", "cc"], True),
        (WHEEL_PROGRAM, True),
        (["gcc"], False),
        (["ccache", "cc"], False),
        (["cc"], False),
    ],
)
def test_zig_is_told_to_compile_for_any_processor(compiler: list[str], answer: bool) -> None:
    assert is_zig(compiler) is answer
    command = compile_command(compiler, ["a.c"], "a.so", {})
    assert command[: len(compiler)] == compiler
    assert ("-mcpu=baseline" in command) is answer
    assert not any(flag.startswith("-march") or flag == "-ffast-math" for flag in command)


@needs_compiler
def test_the_wheel_with_a_compiler_is_asked_for_only_where_there_is_none(tmp_path: Path) -> None:
    for environment, expected in (
        (dict(os.environ), [False, False, False]),
        (bare(PATH=str(tmp_path)), [True, True, False]),
    ):
        command = [sys.executable, "-c", REQUIREMENTS]
        done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        assert [ZIGLANG in line for line in done.stdout.splitlines()] == expected
