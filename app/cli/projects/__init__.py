"""Commands about a project as a whole."""
