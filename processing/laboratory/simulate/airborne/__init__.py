"""Terrain and flights that are hard for filters of airborne points, with their truth."""
