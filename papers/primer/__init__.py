"""Formulas of a text on Bezier curves.

The text: "A Primer on Bezier Curves" (public repository Pomax/BezierInfo-2), English, as of commit
15e5b9654954ab2cc730a8706a584a499fe64ee0 of 2018-12-29. Its displayed formulas and its pseudo-code stand in
`printed/`, one file a chapter, in the order of printing and nothing else of it; what their letters mean stands in
`names.txt`.
"""
