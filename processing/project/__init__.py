"""The project folder and the map in it."""
