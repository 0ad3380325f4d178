"""Expression -> NumPy, CasADi and C text: one path for all."""
