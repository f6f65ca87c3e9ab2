"""What every reader of points gives: chunks, names of fields, delivered floats."""
