"""Makes the models of the tool ``classify`` anew."""
