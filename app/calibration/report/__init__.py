"""A calibration on two to four pages of paper: one page of HTML that needs nothing else and runs no script."""
