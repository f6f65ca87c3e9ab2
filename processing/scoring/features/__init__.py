"""Scores of mapped features, lines and volumes."""
