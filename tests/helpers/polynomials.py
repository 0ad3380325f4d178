"""Polynomials in x and y as tables of coefficients."""

import numpy as np


def polynomial(**coefficients):
    """`x2y1=3` is 3 x^2 y."""
    table = np.zeros((5, 5))
    for name, value in coefficients.items():
        table[int(name[1]), int(name[3])] = value
    return table
