"""What a pane of the section view shows."""
