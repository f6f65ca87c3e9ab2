"""Earthwork: volumes between two grounds, their proof, and deviations from a design."""
