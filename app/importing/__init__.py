"""Importing, and the files outside the project."""
