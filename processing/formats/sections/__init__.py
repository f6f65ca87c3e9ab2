"""Longitudinal and cross sections of routes, as drawings and tables."""
