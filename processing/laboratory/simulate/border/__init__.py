"""What borders a street: barriers, walls, buildings, yards, fields and slopes."""
