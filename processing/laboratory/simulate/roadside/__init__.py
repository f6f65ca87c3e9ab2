"""What stands beside the road: signs, poles, barriers, buildings."""
