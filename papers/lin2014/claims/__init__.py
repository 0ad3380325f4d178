"""The records of the paper, section by section."""
