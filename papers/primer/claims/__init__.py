"""The records of the text, chapter by chapter."""
