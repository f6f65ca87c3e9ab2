"""Recordings: drives with their columns, revolutions, vehicle path and camera images."""
