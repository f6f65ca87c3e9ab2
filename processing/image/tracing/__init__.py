"""Following an edge or a marking from one click to the next."""
