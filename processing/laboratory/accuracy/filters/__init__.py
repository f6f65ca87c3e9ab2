"""Noise and ground filters beside their peers."""
