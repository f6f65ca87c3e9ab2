"""Edges of curbs, measured on the points and joined to lines."""
