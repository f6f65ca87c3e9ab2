"""Barriers beside a road: guard rails, pipes and cables, fences, parapets, noise walls."""
