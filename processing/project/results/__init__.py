"""Results of tools, stored with the project and given back as files."""
