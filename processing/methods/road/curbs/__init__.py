"""Curbs: from steps of scanlines to edges, their types and how certain they are."""
