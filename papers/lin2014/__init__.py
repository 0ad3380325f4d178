"""Lin, Wang, Hu: Semi-structured B-spline for blending two B-spline surfaces (2014)."""
