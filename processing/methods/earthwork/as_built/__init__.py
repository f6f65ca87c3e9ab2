"""As-built control of faces against the design."""
