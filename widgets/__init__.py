"""Views and panels: they show a document and send intentions back."""
