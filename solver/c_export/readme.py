"""The README beside generated C: what is in it, how to call it, and a program that does."""

from __future__ import annotations

from string import Template

import casadi as ca

from semispline.solver.blending import ConstrainedProblem, StatedProblem

_EXAMPLE = Template("""\
#include <stdio.h>
#include "blend.h"

int main(void)
{
    static casadi_real $arrays;
    static casadi_real w[$sz_w];
    static casadi_int iw[$sz_iw];
    const casadi_real *arg[$sz_arg] = {0};
    casadi_real *res[$sz_res] = {0};
    int i;

$calls
    for (i = 0; i < $count; ++i) {
        printf("%.17g%c", points[i], i % 3 == 2 ? '\\n' : ' ');
    }
    return 0;
}
""")

_README = Template("""\
# A blend in C99

Written by `semispline generate --c` from a blend problem: continuity $continuity, $n_rows v-control curves with
$sizes control points. Nothing here needs more than the C library:

    cc -std=c99 -c blend.c

Every function is called as CasADi does it:

    int f(const double **arg, double **res, long long int *iw, double *w, int mem);

`arg[i]` points to input i, `res[i]` to the place of output i (0: not wanted). `iw` and `w` are work space of at least
`f_SZ_IW` and `f_SZ_W` numbers, `arg` and `res` have room for `f_SZ_ARG` and `f_SZ_RES` pointers, `mem` is 0. What comes
back is 0. Nothing is allocated, so calls with work space of their own may run side by side.

Matrices lie column by column. A sparse one holds its nonzeros only; `f_sparsity_out(0)` gives the numbers of rows and
of columns, where each column starts (one entry more than columns), and the row of each nonzero.

| function | inputs | outputs |
|---|---|---|
$table

`points` (and `a`, `b`) are 3 x N: x, y, z of one point after the other, v-control curve after v-control curve, in the
units of the problem.

The constrained problem is min f(x) with g(x) = 0 and lower <= x <= upper. Its unknowns x are the x of all points, then
all y, then all z, in coordinates (point - centre) / size; after them $shape.

- `blend_hessian` is the upper triangle of the Hessian of lam_f f + lam_g'g.
- centre = ($centre)
- size = $size
- the energy that is minimised, in model units, is f times $scale
$solve
## Example

```c
$example```
""")

_SOLVE = Template("""
Contact is linear here, so `blend_solve` is the whole solve: `a` and `b` are the control rows of the bases from the
edge inwards, which `blend_contact` returns as they were in the problem. What was decided there from the points stays
as it was: direction, seam, knots, a natural alpha, a scale of v by lengths.

$reading
""")


def readme(stated: StatedProblem, nlp: ConstrainedProblem, functions: list[ca.Function]) -> str:
    """Return how to call the generated functions, with a program that does."""
    problem = stated.problem
    linear = not any(problem.free)
    centre, size = stated.frame
    natural = dict(zip(("alpha", "beta"), problem.natural, strict=True))
    shape = [f"{name} / sqrt({natural[name]:.17g})" for name in nlp.parameters]
    return _README.substitute(
        continuity=" and ".join(side.continuity for side in stated.sides),
        n_rows=len(problem.form.rows),
        sizes=", ".join(str(row.size) for row in problem.form.rows),
        table="\n".join(_table_line(function) for function in functions),
        shape=" and ".join(shape) or "nothing more",
        scale=f"{nlp.f_scale * size**2:.17g}",
        centre=", ".join(f"{x:.17g}" for x in centre),
        size=f"{size:.17g}",
        solve=_SOLVE.substitute(reading=_reading(stated)) if linear else "",
        example=_example({function.name(): function for function in functions}, linear),
    )


def _table_line(function: ca.Function) -> str:
    def arguments(names: list[str], sparsities: list[ca.Sparsity]) -> str:
        texts = []
        for name, s in zip(names, sparsities, strict=True):
            sparse = "" if s.is_dense() else f", {s.nnz()} nonzeros"
            texts.append(f"{name} ({s.size1()} x {s.size2()}{sparse})")
        return ", ".join(texts) or "none"

    inputs = arguments(function.name_in(), [function.sparsity_in(i) for i in range(function.n_in())])
    outputs = arguments(function.name_out(), [function.sparsity_out(i) for i in range(function.n_out())])
    return f"| `{function.name()}` | {inputs} | {outputs} |"


def _reading(stated: StatedProblem) -> str:
    """Say where the rows of each base stand in its own control net."""
    lines = []
    for name, side in zip("ab", stated.sides, strict=True):
        lines.append(
            f"- `{name}`: {side.order + 1} row(s) of {side.along.size} points, along v of the blend"
            + (", against the direction of its own edge" if name == "b" and stated.matched.flipped else "")
            + (f", from {stated.matched.shift:.17g} after its own seam" if name == "b" and stated.matched.shift else "")
            + f", as a spline of degree {side.along.degree} along it."
        )
    return "\n".join(lines)


def _example(functions: dict[str, ca.Function], linear: bool) -> str:
    """Return a program that prints the control points: of the solution where contact is linear, else of the start."""
    steps: list[tuple[str, tuple[str, ...], tuple[str, ...]]]
    if linear:
        steps = [("contact", (), ("a", "b")), ("solve", ("a", "b"), ("points",))]
    else:
        steps = [("start", (), ("x",)), ("points", ("x",), ("points",))]
    arrays: dict[str, int] = {}
    calls = []
    used = []
    for name, inputs, outputs in steps:
        function = functions[f"blend_{name}"]
        used.append(function)
        calls += [f"    arg[{i}] = {array};" for i, array in enumerate(inputs)]
        calls += [f"    res[{i}] = {array};" for i, array in enumerate(outputs)]
        calls.append(f"    if ({function.name()}(arg, res, iw, w, 0)) return 1;")
        arrays |= {array: function.nnz_out(i) for i, array in enumerate(outputs)}
    sizes = {
        # C has no arrays of length 0.
        f"sz_{part}": str(max(1, *(getattr(function, f"sz_{part}")() for function in used)))
        for part in ("arg", "res", "iw", "w")
    }
    return _EXAMPLE.substitute(
        arrays=", ".join(f"{name}[{size}]" for name, size in arrays.items()),
        calls="\n".join(calls),
        count=arrays["points"],
        **sizes,
    )
