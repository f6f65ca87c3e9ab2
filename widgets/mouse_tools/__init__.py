"""Gestures of the hand, the same in every view."""
