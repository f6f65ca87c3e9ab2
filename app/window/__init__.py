"""The window: its frame, its parts, and actions as data."""
