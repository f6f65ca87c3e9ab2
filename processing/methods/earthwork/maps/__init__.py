"""Grids of change and what is drawn from them."""
