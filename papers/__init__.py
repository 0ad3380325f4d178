"""What was printed: claims of papers, decided against the derivations and measured with the solver."""
