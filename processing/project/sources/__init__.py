"""Delivered files and camera images outside the project."""
