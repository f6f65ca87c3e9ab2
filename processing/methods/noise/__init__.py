"""Which points of a cloud are noise: by radius, by statistics, by what a scanner can measure."""
