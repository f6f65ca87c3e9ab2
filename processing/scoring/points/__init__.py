"""Scores of points' classes and noise."""
