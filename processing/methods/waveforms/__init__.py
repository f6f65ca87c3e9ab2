"""Full waveforms: the pulse of the scanner, and the echoes that samples consist of."""
