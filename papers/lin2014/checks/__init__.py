"""How the claims are decided, and what their errors do to a surface."""
