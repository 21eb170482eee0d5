"""Pictures of results: the command `snapin-plot`, and a module for each kind of picture.

They need Matplotlib, and those of forces f90nml: pip install 'snapin[plots]'.
"""
