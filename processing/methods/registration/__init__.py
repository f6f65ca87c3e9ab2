"""Registration: drives, passes and heads of a survey set on each other and on control points."""
