"""The views' places and what is shown in them."""
