"""Makes the models that tell noise: simulated scenes, examples of what must be kept, trees."""
