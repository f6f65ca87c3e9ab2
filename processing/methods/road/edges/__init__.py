"""Edges of the carriageway where no curb stands: by brightness, roughness and slope."""
