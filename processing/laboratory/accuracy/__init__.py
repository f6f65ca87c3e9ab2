"""Tables of docs/accuracy.md."""
