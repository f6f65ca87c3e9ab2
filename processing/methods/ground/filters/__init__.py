"""Filters that tell ground from what stands on it."""
