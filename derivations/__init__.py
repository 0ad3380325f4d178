"""What must be true: exact derivations in SymPy, and the code generated from them. Imports nothing of ours."""
