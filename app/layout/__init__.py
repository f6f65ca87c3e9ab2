"""How views and panels stand in the window."""
