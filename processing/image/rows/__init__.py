"""How pulses are folded into rows, and pixels into rasters."""
