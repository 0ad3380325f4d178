"""Sums of powers, a sample.

Letters are the paper's: n is a number of terms.
"""
