"""Triangles, boundaries and break lines."""
