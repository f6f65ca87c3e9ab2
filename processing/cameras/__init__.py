"""Camera images: where they look and what they see."""
