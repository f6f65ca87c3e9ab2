"""Trunks and poles of sparse recordings, told in decimetres."""
