"""What moves during a pass."""
