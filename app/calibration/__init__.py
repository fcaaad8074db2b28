"""From reviewed lines to a camera's lens: estimation, uncertainty, focal length, exports and the report. Pure."""
