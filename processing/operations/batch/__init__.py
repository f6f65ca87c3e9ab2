"""The same operations over many drives, on this machine or on a cluster."""
