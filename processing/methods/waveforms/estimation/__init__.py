"""Waveforms for points that were delivered without: what light a pulse sent back, from returns."""
