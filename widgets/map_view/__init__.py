"""The map from above."""
