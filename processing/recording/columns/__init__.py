"""Points as arrays in acquisition order: mapped columns, their order, coordinates and classes."""
