"""What tests and studies share and the program knows nothing of."""
