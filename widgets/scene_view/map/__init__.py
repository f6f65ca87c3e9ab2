"""The map's features in the scene: drawn and hit."""
