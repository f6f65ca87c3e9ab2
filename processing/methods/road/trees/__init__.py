"""Street trees: trunks among the columns beside a road, their girth, and the crowns above them."""
