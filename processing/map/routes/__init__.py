"""Routes: stations along a road's centre line, and what ledgers take from them."""
