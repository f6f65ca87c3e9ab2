"""Tools and their forms."""
