"""Normalised scan lines: cross-sections at even steps, whatever the scanner."""
