"""Fuzz one parser, guided by the code that its inputs reach: `python tools/fuzz.py npz --seconds 60`.

Needs atheris, which isn't among the locked packages: `pip install --target FOLDER atheris`, then `--atheris FOLDER`.
Begins from the files of `tools/fuzzing/seeds.py`; what an input must be packed in is packed anew each time. Memory is
bounded. An input that breaks a parser is written to the folder of `--findings`, and what it raised is printed.
"""

from __future__ import annotations

import argparse
import importlib
import sys
import tempfile
import warnings
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))
MEGABYTES = 1500


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("parser", nargs="?", help="Its name; all names are listed without one.")
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--atheris", type=Path, help="Folder that atheris was installed into.")
    parser.add_argument("--findings", type=Path, default=Path("findings"), help="Where what breaks a parser goes.")
    parser.add_argument("--replay", type=Path, help="Read this one file instead.")
    return parser.parse_args()


def main() -> None:
    given = arguments()
    if given.atheris:
        sys.path.insert(0, str(given.atheris))
    atheris: Any = importlib.import_module("atheris")

    with atheris.instrument_imports(include=["app.formats", "app.images", "app.services.paging", "PIL"]):
        from tools.fuzzing.parsers import PARSERS, outcome
    if given.parser not in PARSERS:
        sys.exit("one of: " + ", ".join(PARSERS))
    warnings.simplefilter("ignore")  # readers warn of odd files; tests tell which warnings get out
    parser = PARSERS[given.parser]
    seeds = parser.seeds()
    forms = list(dict.fromkeys(seed.form for seed in seeds))

    def read(data: bytes) -> None:
        if data:
            outcome(parser, forms[data[0] % len(forms)](data[1:]))

    if given.replay:
        read(given.replay.read_bytes())
        return
    given.findings.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as corpus:
        for number, seed in enumerate(seeds):
            (Path(corpus) / str(number)).write_bytes(bytes([forms.index(seed.form)]) + seed.content)
        options: list[Any] = [
            sys.argv[0],
            corpus,
            f"-max_total_time={given.seconds}",
            f"-rss_limit_mb={MEGABYTES}",
            "-timeout=10",
            "-print_final_stats=1",
            f"-artifact_prefix={given.findings}/{given.parser}-",
        ]
        atheris.Setup(options, read)
        atheris.Fuzz()


if __name__ == "__main__":
    main()
