"""The attributes of what is selected."""
