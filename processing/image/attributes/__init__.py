"""What pixels show: attributes, colours, and the cache of coloured tiles."""
