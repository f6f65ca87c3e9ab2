"""Tools that paint labels."""
