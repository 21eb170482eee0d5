"""Publications that were not available, and results that are not computed yet: text without
rows."""
