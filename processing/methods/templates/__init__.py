"""Templates: a profile drawn once in a section, fitted along the street."""
