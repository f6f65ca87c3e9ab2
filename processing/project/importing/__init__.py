"""Delivered files become drives."""
