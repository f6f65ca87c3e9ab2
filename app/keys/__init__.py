"""Keys, and the form that changes them."""
