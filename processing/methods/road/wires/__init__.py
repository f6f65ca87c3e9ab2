"""Wires between poles: thin things in the air, told apart and fitted as they hang."""
