"""Commands that work without a person: many drives at once, macros."""
