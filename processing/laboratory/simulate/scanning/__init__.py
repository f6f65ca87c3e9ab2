"""How it is recorded: sensors, the drive, beams, what they meet and what comes back."""
