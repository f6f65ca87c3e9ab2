"""Methods: arithmetic that knows no project and no file."""
