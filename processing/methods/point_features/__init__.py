"""What a point is described by: shapes of what is around it, cells, scan lines, the path."""
