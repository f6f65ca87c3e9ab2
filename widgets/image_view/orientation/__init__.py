"""How the image lies on the screen: orientation, what part of it, how it scrolls."""
