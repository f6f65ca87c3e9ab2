"""The two surfaces that are compared: measured, filled in, or designed."""
