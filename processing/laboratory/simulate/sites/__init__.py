"""Earthwork sites of two dates: terrain, what stands on it, scans from tripods."""
