"""Earthwork volumes and their reports."""
