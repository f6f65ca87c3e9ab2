"""Truth of the road as a whole: widths, falls and slopes at stations, and what hangs over it."""
