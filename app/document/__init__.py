"""The open project and the only way to change it."""
