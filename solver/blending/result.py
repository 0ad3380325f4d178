"""What a blend comes to: the surface, and everything that was measured of it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from semispline.solver.blending.band_contact import BandContact
from semispline.solver.blending.candidates import Candidate
from semispline.solver.blending.chain_contact import ChainContact
from semispline.solver.blending.cures import Cure
from semispline.solver.blending.linear_alpha import LinearInV
from semispline.solver.blending.representative import Representative
from semispline.solver.judge import Contact, Crease, Regularity, ShapeReport
from semispline.solver.options import BlendOptions, Continuity
from semispline.solver.proof import Certificate
from semispline.solver.splines import SemiStructuredSurface


@dataclass(frozen=True)
class Objective:
    """What was minimised.

    Attributes
    ----------
    name : str
        "fairness": area times integral of |grad H|^2, jumps of H included, by alpha and p2 (before a bulge).
        "thin plate": (11) with the v-domain's length as `v_scale` has it, by whichever of free rows and alpha is free.
        "nothing" where contacts and options prescribe all.
    value : float or None
    known : str
        What is known of the minimum; "proved" is said of nothing else than what is.
    rows : str
        What the free rows minimise, and to which fraction that is certified; or that there are none.
    """

    name: str
    value: float | None
    known: str
    rows: str


@dataclass(frozen=True, eq=False)
class BlendResult:
    """A blend of two bases, with what was measured of it.

    Attributes
    ----------
    surface : SemiStructuredSurface
        u = 0 on a, u = 1 on b; the v-domain is that of a's edge.
    edges : (str, str)
        What the edges of a and b are called, parts and lines inside included.
    continuity : (str, str)
        Asked for and confirmed at a and at b.
    options : BlendOptions
        All that was chosen for this blend, nothing unsaid.
    candidates : tuple of Candidate
        Layouts that were tried, where the fairest shape was searched.
    objective : Objective
    method : str
        "linear" where nothing but a linear solve was needed.
    energy : float
        Thin-plate energy (11) over [0, 1] x the v-domain, whatever `v_scale` was minimised.
    energy_rounding : float
        By how much rounding of the control points may change it, at most; above 0.001 of the energy `warnings` say so
        and nothing is proved.
    quadrature_error : float or None
        Of `energy`, where the blend is rational, in its unit as `energy_rounding` is: how far a rule of half the nodes
        is off, which is far more than the rule that was used is.
    weights : pair of Representative or None
        How the weights of a rational base were made tame; None for a polynomial one.
    cures : pair of Cure or None
        What was done to the rows of each base so that knots where they are only continuous do not crease the blend,
        and where it is creased all the same; parameters along then correspond by foot points.
    alpha2, beta2 : float, (float, float) or None
        Of (2.1) and (2.2), the bases in their own parameters, the bulge included; 1 for C1 and C2, None for C0 and G0.
        Where linear in v the pair of values at its start and its end.
    alpha2_bounds, beta2_bounds : (float, float) or None
        The admissible box; None where there is no such unknown. Method bfgs does not know it: see `warnings`. Pairs of
        end values where linear in v.
    active_bounds : tuple of str
        Which bounds stopped the search, such as "alpha2 lower" or "p2 of a upper", or were passed by it (method bfgs).
    flipped : bool
        Whether edge b runs against edge a.
    seam_shift : float
        Closed contact curves: how far b was re-seamed, in b's own parameter, to face the seam of a.
    contact_a, contact_b : Contact
        Judged by the de Boor referee.
    seam : Contact or None
        Closed contact curves: how the blend's own edges v0 and v1 meet.
    regularity : Regularity
        How far the blend is from being pinched to nothing.
    creases : tuple of Crease
        Knots of full multiplicity, across which (11) counts nothing, and how far the normal turns there.
    shape : ShapeReport
        How sharply it turns, how fair it is, how it curves and leaves its bases, whether it meets itself or them.
    warnings : tuple of str
        What a user should look at: folds, steep turns, pinches, loops, U-turns, creases, shape parameters at their
        bounds or beyond, an energy that is rounding, contact of which rounding hides a part, bases without a normal
        somewhere.
    iterations : int
        Of the nonlinear solver; 0 where there is none.
    status : str or None
        The nonlinear solver's own word on how it ended.
    search_excess : float or None
        How much more energy the search left than this blend has, as a fraction: `blend` sets the free rows anew from
        the alpha and beta found; only for method bfgs.
    kkt_residual : float or None
        Largest entry of the gradient of the Lagrangian and of multiplier times slack, scaled; only for method casadi.
    certificate : Certificate or None
        Proof that no admissible alpha and beta have less energy, in coordinates of size 1; only for method reduced,
        None where the energy is rounding.
    proven_gap : float or None
        What the proof leaves open, as a fraction of the energy.
    p2 : pair of float or (float, float)
        The second shape parameter of each side, P_uu = alpha^4 R_ww + p2 R_w; 0 where nobody asked for it. A pair of
        end values where it goes with an alpha^2 that is linear in v.
    constraint_rank : (int, int) or None
        Rank of the constraint Jacobian at the solution, and its number of rows; only for method casadi.
    seconds : float
        For the solve, in both directions of b where both were tried, without the final checks.
    band_a, band_b : BandContact or None
        Where a base is a band along a free curve of a face: how the blend meets the face itself.
    chain_a, chain_b : ChainContact or None
        Where a base is a chain: how the blend meets each face of it.
    """

    surface: SemiStructuredSurface
    edges: tuple[str, str]
    continuity: tuple[Continuity, Continuity]
    options: BlendOptions
    candidates: tuple[Candidate, ...]
    objective: Objective
    method: str
    energy: float
    energy_rounding: float
    quadrature_error: float | None
    weights: tuple[Representative | None, Representative | None]
    cures: tuple[Cure | None, Cure | None]
    alpha2: LinearInV | None
    beta2: LinearInV | None
    alpha2_bounds: tuple[LinearInV, LinearInV] | None
    beta2_bounds: tuple[LinearInV, LinearInV] | None
    active_bounds: tuple[str, ...]
    flipped: bool
    seam_shift: float
    contact_a: Contact
    contact_b: Contact
    seam: Contact | None
    regularity: Regularity
    creases: tuple[Crease, ...]
    shape: ShapeReport
    warnings: tuple[str, ...]
    iterations: int
    status: str | None
    search_excess: float | None
    kkt_residual: float | None
    certificate: Certificate | None
    proven_gap: float | None
    p2: tuple[LinearInV, LinearInV]
    constraint_rank: tuple[int, int] | None
    seconds: float
    band_a: BandContact | None = None
    band_b: BandContact | None = None
    chain_a: ChainContact | None = None
    chain_b: ChainContact | None = None

    @property
    def rows_stored(self) -> int:
        """Number of control points of the blend as it is stored."""
        return self.surface.n_control_points

    @cached_property
    def rows_converted(self) -> int:
        """Number of control points of the same surface as an ordinary B-spline, as other programs read it."""
        return int(self.surface.to_bspline().control_points[..., 0].size)
