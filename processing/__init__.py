"""Points, images, features, tools and files; no Qt."""
