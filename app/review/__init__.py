"""The review of candidates."""
