"""Points near each other in the image: normals, components, surroundings."""
