"""Points as text: which column is which, numbers, lines."""
