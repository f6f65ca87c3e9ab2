"""Sections: cuts through the recording, stations along a line, and what a cut shows."""
