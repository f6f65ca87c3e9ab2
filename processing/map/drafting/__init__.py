"""Drawing: constructions, edits and measures of lines as plain arithmetic on values."""
