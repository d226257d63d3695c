"""Quadratic programs, by any of six solvers through qpsolvers, or by daqp's own interface."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from overreach.errors import UnknownNameError
from overreach.extras import require

Array = Any
"""numpy.ndarray; this module is imported without numpy."""

SETTINGS: dict[str, dict[str, float]] = {
    "daqp": {},
    "quadprog": {},
    "piqp": {"eps_abs": 1e-10, "eps_rel": 1e-10},
    "proxqp": {"eps_abs": 1e-9, "eps_rel": 0.0},
    "osqp": {"eps_abs": 1e-9, "eps_rel": 1e-9, "max_iter": 20_000},
    "clarabel": {"tol_gap_abs": 1e-11, "tol_gap_rel": 1e-11, "tol_feas": 1e-11},
}
"""Tolerances with which all agree with quadprog to better than 1e-4 (tested)."""
SPARSE = ("osqp", "clarabel")
"""Solvers that take sparse matrices only."""
DIRECT = "daqp-direct"
"""daqp without qpsolvers around it."""
MODEL = "daqp-model"
"""daqp with its workspace kept from call to call: for a problem of always the same size and bounds, faster still."""
SOLVERS = (*SETTINGS, DIRECT, MODEL)


class Solve(Protocol):
    """min 1/2 x^T P x + q^T x subject to G x <= h, A x = b, lb <= x <= ub; any of G, h and A, b may be None."""

    def __call__(
        self,
        P: Array,
        q: Array,
        lb: Array,
        ub: Array,
        G: Array | None = None,
        h: Array | None = None,
        A: Array | None = None,
        b: Array | None = None,
    ) -> Array | None:
        """Return x, or None where the solver found none. Nothing is raised."""
        ...


def solver(name: str, **settings: float) -> Solve:
    """Return the solver called `name`, with its own settings changed by `settings`.

    Raises UnknownNameError with the valid names, or MissingExtraError without the extra `qp`.
    """
    if name not in SOLVERS:
        raise UnknownNameError("QP solver", name, SOLVERS)
    if name in (DIRECT, MODEL):
        return _direct(settings, name == MODEL)
    qpsolvers = require("qpsolvers", "qp", f"the QP solver {name}")
    if name not in qpsolvers.available_solvers:
        require("proxsuite" if name == "proxqp" else name, "qp", f"the QP solver {name}")
    solve_qp: Callable[..., Array | None] = qpsolvers.solve_qp
    chosen = SETTINGS[name] | settings
    pack = require("scipy.sparse", "qp", f"the QP solver {name}").csc_matrix if name in SPARSE else None

    def solve(
        P: Array,
        q: Array,
        lb: Array,
        ub: Array,
        G: Array | None = None,
        h: Array | None = None,
        A: Array | None = None,
        b: Array | None = None,
    ) -> Array | None:
        if pack is not None:
            P, G, A = (None if matrix is None else pack(matrix) for matrix in (P, G, A))
        try:
            return solve_qp(P, q, G, h, A, b, lb, ub, solver=name, **chosen)
        except Exception:  # whatever a solver raises, the robot is to stand still
            return None

    return solve


def _direct(settings: dict[str, float], keep: bool) -> Solve:
    numpy = require("numpy", "qp", "the QP solver daqp")
    daqp = require("daqp", "qp", "the QP solver daqp")
    run = daqp.solve
    kept: dict[tuple[int, int], tuple[Any, Array, Array]] = {}
    nothing: dict[int, Array] = {}
    senses: dict[tuple[int, int], Array] = {}

    def solve(
        P: Array,
        q: Array,
        lb: Array,
        ub: Array,
        G: Array | None = None,
        h: Array | None = None,
        A: Array | None = None,
        b: Array | None = None,
    ) -> Array | None:
        n = len(q)
        rows, least, most, equal = (
            nothing.setdefault(n, numpy.zeros((0, n))) if G is None and A is None else None,
            lb,
            ub,
            0,
        )
        if G is not None and h is not None:
            rows, most = G, numpy.concatenate((ub, h))
            least = numpy.concatenate((lb, numpy.full(len(h), -1e30)))
        if A is not None and b is not None:
            rows = A if G is None else numpy.vstack((G, A))
            most, least, equal = numpy.concatenate((most, b)), numpy.concatenate((least, b)), len(b)
        key = (len(most), equal)
        sense = senses.get(key)
        if sense is None:
            sense = senses[key] = numpy.zeros(len(most), dtype=numpy.intc)
            sense[len(most) - equal :] = 5  # daqp's code for an equality
        try:
            if keep and G is None and A is None:
                x, flag = warm(P, q, rows, most, least, sense, key)
            else:
                x, _, flag, _ = run(P, q, rows, most, least, sense, **settings)
        except Exception:  # as above
            return None
        return x if flag > 0 else None

    def warm(
        P: Array, q: Array, rows: Array, most: Array, least: Array, sense: Array, key: tuple[int, int]
    ) -> tuple[Array, int]:
        model, ub, lb = kept.get(key, (None, None, None))
        if model is None or ub is not most or lb is not least:
            model = daqp.Model()
            model.setup(P, q, rows, most, least, sense)
            model.settings = settings
            kept[key] = model, most, least
        else:  # with `sense`, or it would begin with the last call's active set: the answer is to be of P and q alone
            model.update(H=P, f=q, sense=sense)
        x, _, flag, _ = model.solve()
        return x, flag

    return solve
