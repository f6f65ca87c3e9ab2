"""The colour behind the points: dark and neutral, so that dim returns can be told from nothing."""

BACKGROUND = "#14171c"
"""``#rrggbb``."""
