"""Bytes to segments and back: the only place that knows foreign file formats. Pure, but for listing folders."""
