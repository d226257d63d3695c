"""Quadratic programs, by any of six solvers through qpsolvers, or by daqp's own interface."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from overreach.baselines.settings import SPARSE, check_settings
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
DIRECT = "daqp-direct"
"""daqp without qpsolvers around it."""
MODEL = "daqp-model"
"""daqp with its workspace kept from call to call: for a problem of always the same size and bounds, faster still."""
SOLVERS = (*SETTINGS, DIRECT, MODEL)


class Solve(Protocol):
    """min 1/2 x^T P x + q^T x subject to lb <= x <= ub and, where they are given, A x = b."""

    def __call__(
        self, P: Array, q: Array, lb: Array, ub: Array, A: Array | None = None, b: Array | None = None
    ) -> Array | None:
        """Return x, or None where the solver found none. Nothing is raised."""
        ...


def solver(name: str, **settings: float) -> Solve:
    """Return the solver called `name`, with its own settings changed by `settings`.

    Raises UnknownNameError with the valid names, SetupError for a value it cannot use, or MissingExtraError without the
    extra `qp`.
    """
    if name not in SOLVERS:
        raise UnknownNameError("QP solver", name, SOLVERS)
    check_settings(name, settings)
    if name == DIRECT:
        return _direct(settings)
    if name == MODEL:
        return _kept(settings)
    qpsolvers = require("qpsolvers", "qp", f"the QP solver {name}")
    if name not in qpsolvers.available_solvers:
        require("proxsuite" if name == "proxqp" else name, "qp", f"the QP solver {name}")
    solve_qp: Callable[..., Array | None] = qpsolvers.solve_qp
    chosen = SETTINGS[name] | settings
    pack = require("scipy.sparse", "qp", f"the QP solver {name}").csc_matrix if name in SPARSE else None

    def solve(P: Array, q: Array, lb: Array, ub: Array, A: Array | None = None, b: Array | None = None) -> Array | None:
        try:
            if pack is not None:
                P, A = pack(P), None if A is None else pack(A)
            return solve_qp(P, q, None, None, A, b, lb, ub, solver=name, **chosen)
        except Exception:  # whatever a solver raises, the robot is to stand still
            return None

    return solve


def _direct(settings: dict[str, float]) -> Solve:
    """Return daqp's own function. What does not change from call to call is made once."""
    numpy = require("numpy", "qp", "the QP solver daqp")
    run = require("daqp", "qp", "the QP solver daqp").solve
    boxes: dict[int, tuple[Array, Array]] = {}

    def solve(P: Array, q: Array, lb: Array, ub: Array, A: Array | None = None, b: Array | None = None) -> Array | None:
        n = len(q)
        if n not in boxes:
            boxes[n] = _box(numpy, n)
        rows, sense = boxes[n]
        try:
            if A is not None and b is not None:
                equal = numpy.full(len(b), 5, dtype=numpy.intc)  # daqp's code for an equality
                rows, sense = A, numpy.concatenate((sense, equal))
                lb, ub = numpy.concatenate((lb, b)), numpy.concatenate((ub, b))
            x, _, flag, _ = run(P, q, rows, ub, lb, sense, **settings)
        except Exception:  # as above
            return None
        return x if flag > 0 else None

    return solve


def _kept(settings: dict[str, float]) -> Solve:
    """Return daqp with its workspace kept, for bounds that stay; other problems go the direct way."""
    numpy = require("numpy", "qp", "the QP solver daqp")
    daqp = require("daqp", "qp", "the QP solver daqp")
    direct = _direct(settings)
    model: Any = None
    bounds: tuple[Array, Array] | None = None
    sense: Array = None

    def solve(P: Array, q: Array, lb: Array, ub: Array, A: Array | None = None, b: Array | None = None) -> Array | None:
        nonlocal model, bounds, sense
        if A is not None:
            return direct(P, q, lb, ub, A, b)
        try:
            if bounds is None or bounds[0] is not lb or bounds[1] is not ub:
                rows, sense = _box(numpy, len(q))
                model = daqp.Model()
                model.setup(P, q, rows, ub, lb, sense)
                model.settings = settings
                bounds = lb, ub
            else:
                # With `sense`, or it would begin with the last call's active set: the answer is to be of P and q alone.
                model.update(H=P, f=q, sense=sense)
            x, _, flag, _ = model.solve()
        except Exception:  # as above
            return None
        return x if flag > 0 else None

    return solve


def _box(numpy: Any, n: int) -> tuple[Array, Array]:
    """Return daqp's rows and senses of a problem with bounds on its n variables and nothing else."""
    return numpy.zeros((0, n)), numpy.zeros(n, dtype=numpy.intc)
