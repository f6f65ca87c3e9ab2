"""The road itself: where it runs, how wide it is, and what its surfaces are."""
