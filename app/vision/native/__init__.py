"""The detector's kernels: a small C library without dependencies, called through ctypes.

`library` loads it and `records` declares what crosses the border; what the kernels do, and why, is told by the modules
of `app.vision` that call them.
"""
