"""The points of the drives in the scene: chosen, loaded, drawn and picked."""
