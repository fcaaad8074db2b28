"""Copying a whole installation's rows from one database to another, of either kind and at any released revision.

What the tables are is read from the source itself, so an older schema is copied as it is. Rows are read from one
snapshot: whoever works with the source meanwhile isn't held up, and what they do isn't in the copy.
"""
