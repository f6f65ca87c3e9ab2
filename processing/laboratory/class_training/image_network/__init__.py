"""The thesis' image network, and the forest on its intermediate features (M, M&A, M&A&I)."""
