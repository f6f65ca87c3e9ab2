"""Rows of a recording without any time, from the order in which its points were measured."""
