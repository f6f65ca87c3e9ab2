"""Streets put together from their makers."""
