"""Jobs in the background, and the log."""
