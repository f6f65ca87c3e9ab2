"""Tools that change what is drawn."""
