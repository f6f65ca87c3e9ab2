"""Roads as a whole: their model as a plot in a window of its own."""
