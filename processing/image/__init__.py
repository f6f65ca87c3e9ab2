"""The point-cloud image: rows and pixels over a drive."""
