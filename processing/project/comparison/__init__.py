"""A map that was delivered before, against the map of a project."""
