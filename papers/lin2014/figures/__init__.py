"""The figures, drawn anew."""
