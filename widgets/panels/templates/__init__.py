"""Templates: drawn, listed, fitted."""
