"""Running tools on drives."""
