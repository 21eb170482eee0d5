"""The work of others, one module for each chapter."""
