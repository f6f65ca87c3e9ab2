"""Points found through the tiles: nearest, enclosed, along a line of sight, in view."""
