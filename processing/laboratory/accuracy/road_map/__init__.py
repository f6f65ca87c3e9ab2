"""Accuracy of the tools of the road map."""
