"""What stands beside a road: its plan, the ground under it, its columns and the points on them."""
