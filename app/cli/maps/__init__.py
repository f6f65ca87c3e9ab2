"""Commands about the map of a project."""
