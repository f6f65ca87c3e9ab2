"""Steps on scan lines, linked along the street and filtered."""
