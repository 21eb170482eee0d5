"""What could not be read, and what is not computed yet: the page says it, and has no rows."""
