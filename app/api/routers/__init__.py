"""Routes, one file per thing they are about."""
