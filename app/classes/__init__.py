"""Classes of points: labels, truths, evaluation."""
