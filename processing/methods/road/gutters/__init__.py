"""Covered gutters: from holes between lids to rows of lids, gratings and their outline."""
