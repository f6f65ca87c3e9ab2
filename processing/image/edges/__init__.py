"""Edges of surfaces in the image, and the laser's line of sight."""
