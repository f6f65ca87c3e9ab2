"""Where the vehicle was: trajectories, their clocks, and the smoothed path along a street."""
