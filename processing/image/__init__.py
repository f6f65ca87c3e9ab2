"""The point-cloud image: rows, pixels, tiles and what they show."""
