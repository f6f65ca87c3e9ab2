"""The camera view: the image that sees the cursor best, with the map drawn into it."""
