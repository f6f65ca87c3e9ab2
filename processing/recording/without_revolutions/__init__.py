"""What stands in for revolutions: a standing scanner's grid, cells of the top view."""
