"""Recordings: columns, trajectories, turns and pulses."""
