"""Workers on other machines, through Dask; which takes a second to import, so whoever needs it imports it late."""
