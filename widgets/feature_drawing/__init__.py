"""How features are drawn and hit in every view."""
