"""Where the end curves of a blend have to lie: on the faces at both ends of its contacts.

A contact is exact whatever reparametrisation the blend follows. Near its ends the blend may therefore leave along
X(u, v) = R(w(u), v + q(u, v)) with q chosen at the end so that the line X(u, v0) stays on the end face, order by order:
the derivative of order j holds q_j R_v, and nothing else that is unknown.

Source: `semispline.derivations.chains`.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import comb

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.blending.reparametrisation import Reparametrisation, composed
from semispline.solver.errors import EdgeError

# Sine of the angle at which a contact may meet an end face at least.
_GRAZING = 0.05
# What leaves a face by less, of its own size, stays on it.
_ON_FACE = 1e-12


@dataclass(frozen=True, eq=False)
class EndFace:
    """A face near the end of a contact, to second order.

    Attributes
    ----------
    normal : ndarray, shape (3,)
        Of unit length.
    bending : ndarray, shape (3, 3)
        x . bending . y is the second fundamental form of tangent vectors x and y: by it a curve on the face with the
        derivatives x and z has normal . z = x . bending . x. Zero for a plane.
    """

    normal: FloatArray
    bending: FloatArray

    @property
    def is_flat(self) -> bool:
        """Whether it is a plane."""
        return not self.bending.any()

    @classmethod
    def plane(cls, normal: FloatArray) -> EndFace:
        """Return a plane with a normal of any length."""
        return cls(np.asarray(normal / np.linalg.norm(normal)), np.zeros((3, 3)))


@dataclass(frozen=True, eq=False)
class HeldEnd:
    """A plane in which rows end.

    Attributes
    ----------
    end : {0, 1}
        Of v.
    normal : ndarray, shape (3,)
    """

    end: int
    normal: FloatArray


def steered(derivatives: FloatArray, by: FloatArray, face: EndFace) -> FloatArray:
    """Return the reparametrisation at an end of a contact by which the line across it stays on a face.

    Parameters
    ----------
    derivatives : ndarray, shape (order + 1, order + 2, d)
        Of R at the end by w and v, homogeneous where d is 4.
    by : ndarray, shape (3, order + 1)
        lambda, w and q there, by order in u, without what is sought.
    face : EndFace

    Returns
    -------
    ndarray, shape (3, order + 1)
        With q_1 to q_order set; above the second order as if the face went on with the same curvature.

    Raises
    ------
    EdgeError
        The contact runs along the face.
    """
    order, found = by.shape[1] - 1, by.copy()
    along = _cartesian(derivatives[0, :2])[1]
    speed = float(np.linalg.norm(along))
    if abs(face.normal @ along) < _GRAZING * speed:
        angle = np.degrees(np.arcsin(min(1.0, abs(face.normal @ along) / speed)))
        raise EdgeError(
            f"end face: the contact meets it at {angle:.2g} degrees, expected {np.degrees(np.arcsin(_GRAZING)):.2g} at "
            "least; the blend's end curve cannot be kept on it"
        )
    for j in range(1, order + 1):
        curve = _cartesian(composed(derivatives[:, :, None], Reparametrisation.of(found))[:, 0])
        # Derivative of order j of the condition along the curve: of what bends only products of lower ones.
        bent = sum(comb(j - 1, i) * curve[j - 1 - i] @ face.bending @ curve[i + 1] for i in range(j - 1))
        off = bent - face.normal @ curve[j]
        # Rounding alone would raise the degree along.
        if abs(off) > _ON_FACE * max(float(np.linalg.norm(curve[j])), float(np.linalg.norm(curve[1]))):
            found[2, j] += off / (face.normal @ along)
    return found


def _cartesian(jets: FloatArray) -> FloatArray:
    """Return derivatives of the curve X / om from those of (X, om); of three columns themselves."""
    if jets.shape[1] == 3:
        return jets
    found = np.zeros((len(jets), 3))
    for j in range(len(jets)):
        rest = jets[j, :3] - sum((comb(j, i) * jets[i, 3] * found[j - i] for i in range(1, j + 1)), np.zeros(3))
        found[j] = rest / jets[0, 3]
    return found
