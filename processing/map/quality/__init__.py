"""What stands against handing in a map: rules, and what breaks them."""
