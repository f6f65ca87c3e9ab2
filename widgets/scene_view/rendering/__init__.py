"""Camera, projection and VTK actors of the 3D view."""
