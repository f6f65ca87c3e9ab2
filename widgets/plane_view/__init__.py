"""What the views share that show the map on a plane: section, camera and map."""
