"""Archives of points without waveforms, classified as the thesis does, against their truth."""
