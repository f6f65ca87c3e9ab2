"""Covers in carriageways and walks: manholes, valves, hand holes, gratings of inlets."""
