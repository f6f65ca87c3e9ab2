"""Classes of points: features of surroundings, trees that weigh them, neighbours that agree."""
