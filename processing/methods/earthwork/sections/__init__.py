"""Cross-sections of two grounds, and volumes by them."""
