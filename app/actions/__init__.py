"""What users can do, as data, by menu."""
