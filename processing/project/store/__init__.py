"""The database of a project: features, history, labels, settings, runs."""
