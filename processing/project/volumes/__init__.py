"""Volumes kept with a project."""
