"""Curbs and gutters on streets whose truth is known."""
