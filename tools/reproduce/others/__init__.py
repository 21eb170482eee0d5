"""What others published, a module a chapter."""
