"""Which points are ground: the published method, and one that asks for no parameter."""
