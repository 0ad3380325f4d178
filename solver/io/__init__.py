"""Files: JSON of our own, CAD formats, meshes. `surface_files` is the way in and out for all of them."""
