"""What all views of a window share."""
