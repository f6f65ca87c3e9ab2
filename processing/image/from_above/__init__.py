"""Drives seen from above."""
