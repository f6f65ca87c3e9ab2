"""A map against the one before it: what is new, moved and gone."""
