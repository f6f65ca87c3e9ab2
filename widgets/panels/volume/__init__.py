"""The panel of earthwork volumes."""
