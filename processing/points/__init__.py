"""Recordings: columns, trajectories, revolutions and pulses."""
