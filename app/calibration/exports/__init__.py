"""A lens in the files that other tools read, each refitted and with its own conversion error."""
