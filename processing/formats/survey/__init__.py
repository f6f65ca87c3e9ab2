"""Formats in which Japanese survey offices exchange maps: X is northing, Y is easting."""
