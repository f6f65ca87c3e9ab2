"""The quality report of a map: PDF, HTML and JSON."""
