"""Makes the networks that estimate waveforms: flights of drawn scanners, examples, fit."""
