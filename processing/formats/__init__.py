"""One file per format: reading and writing, nothing about projects."""
