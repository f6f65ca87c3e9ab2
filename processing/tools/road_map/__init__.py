"""Tools for the other lines and areas of a road map: paint, barriers, walls, edges, covers."""
