"""Comparison of two surfaces: cut, fill, registration and uncertainty."""
