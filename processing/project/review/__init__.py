"""The order and the state of a review."""
