"""Roads as driving simulators and automated vehicles take them."""
