"""Photographs of a simulated street, as deliveries have them."""
