"""What helps a person to judge candidates: suggestions, their order, families, and how far people agree.

Pure functions over segments and arrays; no web, no database, no files but the prior model that lies beside the code.
Coordinates are px, x right, y down, with the pixel's centre at integers.
"""

from __future__ import annotations
