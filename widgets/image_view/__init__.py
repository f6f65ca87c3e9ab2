"""The 2D view in which every laser point is a pixel."""
