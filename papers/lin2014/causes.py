"""What is wrong in the paper, each fault once: records name it as their cause."""

from __future__ import annotations

from semispline.papers.ledger import Cause

CAUSES = (
    Cause(
        "second-derivative",
        "The second derivative at a clamped end",
        "It is a difference of first derivatives over two spans; printed is a plain second difference over one. From "
        "the appendix it goes into (3.1) and (3.2), which then depend on the scale of the base's parameter and on "
        "knots inserted into the base, though neither changes the surface; with squares or other powers, "
        "if the scan lost them, on inserted knots still.",
    ),
    Cause(
        "sign-of-p1",
        "The sign of p_1",
        "The blend leaves R where w falls, so that p_1 is negative; the appendix chooses alpha^2, and by its own "
        "derivatives that gives (2.1) with the other sign. (2.1) itself is right.",
    ),
    Cause(
        "linear-system",
        "The linear system (14)",
        "Its entries are products of integrals where integrals of products are needed. For the unknown control "
        "points a_ij and c_ij are zero, so that A has rank 1 at most, and with one letter as it is printed (14) says "
        "0 = 0.",
    ),
    Cause(
        "indices-for-cubics",
        "Indices that are right for k = 4 alone",
        "The last inner knot of U is u_{m-k+1}, not u_{m-3}; and six rows need m >= 5, whatever k is.",
    ),
    Cause(
        "knots-rule",
        "The rule for the knots of the middle curve",
        "No range is printed for the pairs, and what becomes of a knot without a partner is not said; averages belong "
        "to neither base, so that a converted blend has knots that neither base has.",
    ),
    Cause(
        "energy-for-quality",
        "The energy (11) stands for quality",
        "It depends on the parametrisation, it is least where alpha or beta vanishes for many bases, and more control "
        "points never raise it where one space contains the other.",
    ),
    Cause(
        "misprints",
        "Single signs, indices and digits",
        "Each is right with one letter or digit changed.",
        misprint=True,
    ),
)
