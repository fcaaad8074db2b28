"""What the REST API takes and gives; every model becomes a type of the browser tool."""
