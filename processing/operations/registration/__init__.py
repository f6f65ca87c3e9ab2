"""Registering drives: what is asked of it, and what is written of it."""
