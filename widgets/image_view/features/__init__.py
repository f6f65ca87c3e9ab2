"""The map's features on the image."""
