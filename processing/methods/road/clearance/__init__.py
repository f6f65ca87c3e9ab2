"""What hangs into the room that must be kept free over a road."""
