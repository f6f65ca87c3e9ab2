"""Trajectories and lists of camera images."""
