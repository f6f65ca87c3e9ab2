"""Processing tools and their declarations."""
