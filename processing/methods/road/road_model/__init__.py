"""A road as its map and its points tell it: widths, falls, slopes and clearance at stations."""
