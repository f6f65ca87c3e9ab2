"""The measured surface of a road: its heights in small cells, and where its carriageway ends."""
