"""What runs of tools left behind, and what a repeated one changes."""
