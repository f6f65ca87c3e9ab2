"""What grows beside the road: trees in their pits, hedges, weeds."""
