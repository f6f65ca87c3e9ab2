"""Drawing and editing by hand."""
