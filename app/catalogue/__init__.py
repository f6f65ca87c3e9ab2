"""An office's catalogue."""
