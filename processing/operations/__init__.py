"""Operations on projects and files, each a value and a function."""
