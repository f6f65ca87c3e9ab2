"""Curbs, gutters and what else lies along a road, found on the rows of a recording."""
