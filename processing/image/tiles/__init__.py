"""The pyramid of tiles and their bounds."""
