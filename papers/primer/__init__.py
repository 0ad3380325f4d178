"""Formulas of a text on Bezier curves (A Primer on Bezier Curves, as of 29 December 2018).

The text: public repository Pomax/BezierInfo-2, English, commit 15e5b9654954ab2cc730a8706a584a499fe64ee0. Its displayed
formulas and its pseudo-code stand in `printed/`, one file a chapter, in the order of printing and nothing else of it;
what their letters mean stands in `names.txt`. Letters are the text's.
"""
