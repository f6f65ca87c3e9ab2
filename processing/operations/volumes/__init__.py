"""Volumes as operations: two grounds opened, compared, judged, and written or kept."""
