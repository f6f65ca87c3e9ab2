"""The pulse behind a point."""
