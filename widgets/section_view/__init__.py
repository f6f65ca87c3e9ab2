"""The section view: cuts through the recording, across or along a line, drawn in like a view."""
