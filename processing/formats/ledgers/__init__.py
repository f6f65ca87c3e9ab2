"""Ledgers as tables."""
