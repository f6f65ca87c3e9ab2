"""PulseWaves: pulses with their waveforms, ``.pls`` with its ``.wvs``, whose echoes are points."""
