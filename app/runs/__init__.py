"""Running tools from the window."""
