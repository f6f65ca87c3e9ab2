"""Scores of echoes and waveforms of flights."""
