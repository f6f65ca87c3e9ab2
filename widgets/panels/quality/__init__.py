"""The map looked through, and its findings gone through."""
