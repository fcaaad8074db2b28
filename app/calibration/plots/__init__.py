"""Plots of a calibration as SVG: text in, text out, no script, for the screen and for paper."""
