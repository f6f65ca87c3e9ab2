"""Forms beside the window."""
