"""Tools that an office adds: Python files in a folder."""
