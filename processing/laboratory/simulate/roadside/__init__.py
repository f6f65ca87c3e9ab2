"""What stands beside the road: plants, signs, poles, barriers, buildings."""
