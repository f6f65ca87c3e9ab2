"""Beams: where they began, and what lies behind what they met."""
