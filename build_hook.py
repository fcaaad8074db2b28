"""Build hook of hatchling: puts the browser tool and the compiled kernels into the wheel."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any, cast

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.builders.wheel import WheelBuilder, WheelBuilderConfig

# hatchling loads this file by its path
sys.path.insert(0, str(Path(__file__).resolve().parent))

from build_frontend import build_frontend
from build_native import ZIGLANG, build_library, find_compiler


class BuildHook(BuildHookInterface[WheelBuilderConfig]):
    """Runs before a wheel is made; for an editable installation too, which then uses what was built in the tree."""

    def dependencies(self) -> list[str]:
        """Ask for the compiler of the wheel ``ziglang`` (100 MB) only where there is no other."""
        return [] if self.target_name != "wheel" or find_compiler(os.environ) else [ZIGLANG]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build both, and tag the wheel: any Python 3, this platform."""
        del version
        if self.target_name != "wheel":
            return
        root = Path(self.root)
        build_frontend(root)
        library = build_library(root)
        builder = cast(WheelBuilder, self.build_config.builder)
        platform = builder.get_best_matching_tag().rpartition("-")[2]
        build_data["artifacts"].append(f"/{library.relative_to(root.resolve()).as_posix()}")
        build_data.update(pure_python=False, infer_tag=False, tag=f"py3-none-{platform}")
