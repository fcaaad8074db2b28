"""Print the Chromium that the browser tests use; install one from the npm registry where the machine has none.

The npm package ``@sparticuz/chromium`` brings a browser with the libraries it needs (66 MB). It is unpacked once into
``.tools/browser``, with a starter that points the browser at its libraries.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from build_frontend import node_environment, run_npm  # noqa: E402

FOLDER = ROOT / ".tools" / "browser"
STARTER = FOLDER / "chromium-with-libraries"
NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable")
FONTS_CONF = """<?xml version="1.0"?>
<!DOCTYPE fontconfig SYSTEM "fonts.dtd">
<fontconfig>
  <dir>{folder}/fonts/fonts</dir>
  <dir>/usr/share/fonts</dir>
  <cachedir>{folder}/fonts/cache</cachedir>
</fontconfig>
"""
UNPACK = "import chromium from '@sparticuz/chromium'; console.log(await chromium.executablePath());"


def installed_browser() -> Path | None:
    """Return the browser that CLEARLINES_TEST_BROWSER names, the machine's own, or the one installed before."""
    named = os.environ.get("CLEARLINES_TEST_BROWSER")
    if named:
        return Path(named)
    found = next(filter(None, map(shutil.which, NAMES)), None)
    if found:
        return Path(found)
    return STARTER if STARTER.is_file() else None


def install_browser() -> Path:
    """Fetch the package at the version and hash of its lock file, unpack it, and return the starter."""
    FOLDER.mkdir(parents=True, exist_ok=True)
    for name in ("package.json", "package-lock.json"):
        shutil.copy(ROOT / "tests" / "e2e" / "browser" / name, FOLDER)
    run_npm("ci", "--no-audit", "--no-fund", folder=FOLDER)
    # the package unpacks into the temporary folder, and its libraries only where it believes to be in a cloud function
    environment = {**node_environment(), "TMPDIR": str(FOLDER), "AWS_EXECUTION_ENV": "AWS_Lambda_nodejs22.x"}
    unpack = [str(shutil.which("node", path=environment["PATH"])), "--input-type=module", "--eval", UNPACK]
    done = subprocess.run(unpack, cwd=FOLDER, env=environment, check=True, capture_output=True, text=True)
    chromium = Path(done.stdout.strip())
    # the package's own looks for fonts elsewhere, and a browser without any font crashes
    (FOLDER / "fonts" / "fonts.conf").write_text(FONTS_CONF.format(folder=FOLDER))
    STARTER.write_text(
        "#!/bin/sh\n"
        f'export LD_LIBRARY_PATH="{FOLDER}/al2023/lib:{FOLDER}${{LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}}"\n'
        f'export FONTCONFIG_FILE="{FOLDER}/fonts/fonts.conf"\n'
        f'exec "{chromium}" "$@"\n'
    )
    STARTER.chmod(0o755)
    return STARTER


def main() -> int:
    """Print where the browser is."""
    browser = installed_browser() or install_browser()
    sys.stdout.write(f"{browser}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
