"""LAS and LAZ, read and written."""
