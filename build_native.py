"""Compile the detector's kernels, ``app/vision/native/*.c``, into one shared library: ``python build_native.py``.

They need nothing but the C library and are loaded with ctypes, so one library serves every version of Python. The
compiler is the one that ``CC`` names, else the machine's, else the PyPI wheel ``ziglang``. Flags of the environment
(``CFLAGS``) are left out on purpose: with others, results could differ between machines.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import platform
import shlex
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

NATIVE = Path("app", "vision", "native")
# one narrow range, so that machines without a compiler make the same library
ZIGLANG = "ziglang>=0.17.1,<0.18"
COMPILERS = ("cc", "gcc", "clang")
FLAGS = (
    "-std=c11",
    "-O3",
    "-g0",
    "-shared",
    "-fvisibility=hidden",
    # a fused multiply-add rounds once where two operations round twice: the last bits would depend on the processor
    "-ffp-contract=off",
    "-fno-math-errno",
    "-fno-trapping-math",
    "-Wall",
    "-Wextra",
)
PROBE = """
#include <math.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
int64_t probe(double value) { return (int64_t)sqrt(value); }
"""
ADVICE = f"""Any C11 compiler will do: "apt install gcc libc6-dev" on Debian and Ubuntu, "dnf install gcc" on Fedora,
"xcode-select --install" on macOS, or, everywhere, the wheel: pip install "{ZIGLANG}".
CC=... in the environment names another one."""


class CompileError(RuntimeError):
    """The library could not be made; the message says which command failed, what it said, and what to install."""


def library_name() -> str:
    """Return the library's file name on this platform."""
    return {"darwin": "_kernels.dylib", "win32": "_kernels.dll"}.get(sys.platform, "_kernels.so")


def is_zig(compiler: Sequence[str]) -> bool:
    """Say whether a command is ``zig cc``, whose defaults differ from those of gcc and clang."""
    return len(compiler) > 1 and compiler[-1] == "cc" and Path(compiler[-2]).stem in {"zig", "python-zig", "ziglang"}


def zig_target() -> str | None:
    """Return what ``zig cc`` shall compile for: this processor, and an old system so that the library runs on most."""
    machine = platform.machine().lower()
    processor = {"amd64": "x86_64", "x86_64": "x86_64", "arm64": "aarch64", "aarch64": "aarch64"}.get(machine)
    if processor is None:
        return None
    if sys.platform == "darwin":
        return f"{processor}-macos.11.0"
    if sys.platform == "win32":
        return f"{processor}-windows-gnu"
    return f"{processor}-linux-{'gnu.2.28' if platform.libc_ver()[0] == 'glibc' else 'musl'}"


def machine_flags(compiler: Sequence[str], environment: Mapping[str, str]) -> list[str]:
    """Return the flags that depend on compiler and platform."""
    flags = [] if sys.platform == "win32" else ["-fPIC"]
    if sys.platform == "darwin":
        # the name that the linker notes in the library is otherwise the path of a temporary file
        flags.append(f"-Wl,-install_name,@rpath/{library_name()}")
    if is_zig(compiler):
        target = zig_target()
        # without -mcpu zig compiles for the very processor it runs on
        return [*flags, *(["-target", target] if target else []), "-mcpu=baseline"]
    # the wheel's tag follows ARCHFLAGS on macOS, and so must its content
    return [*flags, *shlex.split(environment.get("ARCHFLAGS", ""))] if sys.platform == "darwin" else flags


def run_compiler(command: Sequence[str], folder: Path, environment: Mapping[str, str]) -> None:
    """Run a compiler in a folder.

    Raises:
        CompileError: It isn't there, or it fails.
    """
    with tempfile.TemporaryDirectory() as cache:
        # zig otherwise fills a folder of the user's home, and fails where there is none
        caches = {"ZIG_GLOBAL_CACHE_DIR": cache, "ZIG_LOCAL_CACHE_DIR": cache}
        try:
            done = subprocess.run(
                command, cwd=folder, env={**environment, **caches}, capture_output=True, text=True, errors="replace"
            )
            failure = None if done.returncode == 0 else f"exit status {done.returncode}\n{done.stdout}{done.stderr}"
        except OSError as error:
            failure = str(error)
        if failure is not None:
            message = f"the detector's kernels were not compiled\n\n{shlex.join(command)}\n(in {folder})\n{failure}"
            raise CompileError(f"{message.rstrip()}\n\n{ADVICE}")


def compile_command(
    compiler: Sequence[str], sources: Sequence[str], output: str, environment: Mapping[str, str]
) -> list[str]:
    """Return the command that makes a shared library of C sources."""
    libraries = [] if sys.platform == "win32" else ["-lm"]
    return [*compiler, *FLAGS, *machine_flags(compiler, environment), *sources, "-o", output, *libraries]


def works(compiler: Sequence[str], environment: Mapping[str, str]) -> bool:
    """Say whether a compiler makes libraries: gcc without the C library's headers is common, as is macOS's empty cc."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "probe.c").write_text(PROBE)
        try:
            run_compiler(compile_command(compiler, ["probe.c"], library_name(), environment), folder, environment)
        except CompileError:
            return False
    return True


def find_compiler(environment: Mapping[str, str]) -> list[str] | None:
    """Return the compiler's command; None where only the wheel ``ziglang``, not installed yet, can help."""
    if environment.get("CC", "").strip():
        return shlex.split(environment["CC"], posix=os.name == "posix")
    for name in COMPILERS:
        found = shutil.which(name, path=environment.get("PATH", ""))
        if found and works([found], environment):
            return [found]
    if importlib.util.find_spec("ziglang") is not None:
        return [sys.executable, "-m", "ziglang", "cc"]
    return None


def content_hash(folder: Path) -> str:
    """Return a hash of every file that the compiler reads."""
    digest = hashlib.sha256()
    for path in sorted(folder.glob("*.[ch]")):
        content = path.read_bytes()
        digest.update(f"{path.name} {len(content)}\n".encode() + content)
    return digest.hexdigest()


def is_built(output: Path, content: str, command: Sequence[str] | None) -> bool:
    """Say whether a library was made of these sources, and by this command where there is one to make it anew."""
    stamp = output.with_suffix(".stamp")
    if not output.is_file() or not stamp.is_file():
        return False
    made_of, _, made_by = stamp.read_text().partition("\n")
    return made_of == content and (command is None or made_by == shlex.join(command))


def build_library(
    root: Path,
    *,
    output: Path | None = None,
    flags: Sequence[str] = (),
    environment: Mapping[str, str] | None = None,
) -> Path:
    """Make the library unless it is there and was made of the same sources with the same flags.

    It appears whole or not at all; a running program keeps the one that it has loaded.

    Args:
        root: The folder of the project.
        output: Where to write the library; beside its sources when not given.
        flags: Further flags; they win over the usual ones.
        environment: Where to look for ``CC`` and ``PATH``; the process's own when not given.

    Returns:
        The library's path.

    Raises:
        CompileError: No source, no compiler, or the compiler fails.
    """
    environment = os.environ if environment is None else environment
    folder = (root / NATIVE).resolve()
    output = (output or folder / library_name()).resolve()
    sources = sorted(path.name for path in folder.glob("*.c"))
    if not sources:
        raise CompileError(f"no C sources in {folder}: this copy of the project is not whole")
    content = content_hash(folder)
    compiler = find_compiler(environment)
    if compiler is None:
        if is_built(output, content, None):
            return output
        raise CompileError(f"the detector's kernels were not compiled: no C compiler was found\n\n{ADVICE}")
    # the wheel's Python may live in a folder made for this build alone, which is no reason to compile again
    lasting = ["zig", "cc"] if is_zig(compiler) else compiler
    recorded = [*compile_command(lasting, sources, output.name, environment), *flags]
    if is_built(output, content, recorded):
        return output
    output.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix="_kernels.", dir=output.parent) as temporary:
        made = Path(temporary, output.name)
        run_compiler([*compile_command(compiler, sources, str(made), environment), *flags], folder, environment)
        stamp = Path(temporary, "stamp")
        stamp.write_text(f"{content}\n{shlex.join(recorded)}")
        made.replace(output)
        stamp.replace(output.with_suffix(".stamp"))
    return output


if __name__ == "__main__":
    try:
        sys.stdout.write(f"{build_library(Path(__file__).resolve().parent)}\n")
    except CompileError as failed:
        sys.exit(str(failed))
