"""Poles: shafts among the columns beside a road, what they carry, and of which type each is."""
