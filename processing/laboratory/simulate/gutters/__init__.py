"""Covered gutters: their beds, lids and gratings, and what lies on them."""
