"""What is computed: B-spline surfaces, semi-structured blends, and independent checks. Never imports SymPy."""
