"""Full waveforms of a recording: packets of samples, the pulses they are of, and their returns."""
