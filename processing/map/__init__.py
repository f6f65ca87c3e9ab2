"""Values of the map: features, catalogue, changes."""
