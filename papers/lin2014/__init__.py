"""Semi-structured B-spline for blending two B-spline surfaces (2014, doi 10.1016/j.camwa.2014.07.013)."""
