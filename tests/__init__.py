"""Tests: they mirror the folders of the program, and judge whole journeys."""
