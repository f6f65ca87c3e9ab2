"""What the program remembers of its user: language, theme, layout."""
