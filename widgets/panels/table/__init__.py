"""What the feature table is made of: rows, columns, marks and the menu."""
