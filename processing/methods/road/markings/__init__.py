"""Road markings: paint told from the road around it, strokes of it followed, lines made of them."""
