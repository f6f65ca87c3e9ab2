"""Drives, runs, layers and labels of the project."""
