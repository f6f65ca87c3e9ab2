"""Features as files and texts of GIS programs."""
