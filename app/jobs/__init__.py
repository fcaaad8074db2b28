"""Work in the background: rows in the database, worked off by processes."""
