"""Streets and sites made to order: what a scanner would record there, and the truth about it."""
