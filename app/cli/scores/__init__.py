"""Scores as lines and tables of the terminal."""
