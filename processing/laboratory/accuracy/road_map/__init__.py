"""The other lines of a road map, held against streets whose truth is known."""
