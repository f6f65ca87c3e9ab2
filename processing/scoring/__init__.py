"""How near results come to a known truth."""
