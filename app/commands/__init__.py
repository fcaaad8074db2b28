"""What the commands do, as functions of paths: no server, no database, nothing printed."""
