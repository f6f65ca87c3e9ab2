"""Walls, retaining walls and faces of buildings: upright planes, their feet and tops."""
