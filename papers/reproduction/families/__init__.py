"""Families of pairs on which blends are judged: made ones by family and seed, real ones from public CAD files."""
