"""Notches: where rows of a recording dip into the road, and how steeply beams came in there."""
