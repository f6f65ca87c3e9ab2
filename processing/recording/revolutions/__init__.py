"""Rows and pulses of a rotating scanner, found in the recording itself."""
