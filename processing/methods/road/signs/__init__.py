"""Road signs: plates found on the scan lines that cross them, their shape and size by templates."""
