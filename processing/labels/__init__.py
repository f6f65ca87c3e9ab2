"""Labels by hand: which points a stroke of the brush means, and how strokes are kept small."""
