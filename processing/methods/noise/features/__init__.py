"""What is measured of a point before the trees decide."""
