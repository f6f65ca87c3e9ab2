"""Surfaces and grids."""
