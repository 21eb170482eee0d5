"""The common parts of tests and studies, independent of the program."""
