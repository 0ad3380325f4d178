"""Files: JSON of our own, and CAD formats."""
