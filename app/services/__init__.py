"""What ClearLines does, as plain functions over a database session; no HTTP."""
