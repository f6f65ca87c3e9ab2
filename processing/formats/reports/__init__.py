"""Reports on paper and as tables."""
