"""Settings of the QP solvers: a name that a solver does not have, or a value it cannot use, fails at set-up."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any

from overreach.errors import SetupError, UnknownNameError, told
from overreach.extras import require

SPARSE = ("osqp", "clarabel")
"""Solvers that take sparse matrices only."""
QUADPROG = ("factorized",)
PROXQP = (
    "check_duality_gap", "compute_preconditioner", "compute_timings", "eps_abs", "eps_duality_gap_abs",
    "eps_duality_gap_rel", "eps_rel", "initial_guess", "max_iter", "mu_eq", "mu_in",
    "primal_infeasibility_solving", "rho",
)  # fmt: skip
"""The keywords of proxsuite's `solve`, which cannot be asked for them."""


def _public(thing: object) -> list[str]:
    return [name for name in dir(thing) if not name.startswith("_")]


def _daqp() -> Iterable[str]:
    return list(require("daqp", "qp", "the QP solver daqp").Model().settings)


def _piqp() -> Iterable[str]:
    return _public(require("piqp", "qp", "the QP solver piqp").DenseSolver().settings)


def _clarabel() -> Iterable[str]:
    return _public(require("clarabel", "qp", "the QP solver clarabel").DefaultSettings())


def _osqp() -> Iterable[str]:
    numpy, sparse = require("numpy", "qp", "osqp"), require("scipy.sparse", "qp", "osqp")
    one, unit = sparse.eye(1).tocsc(), numpy.ones(1)
    problem = require("osqp", "qp", "the QP solver osqp").OSQP()
    problem.setup(P=one, q=unit, A=one, l=-unit, u=unit, verbose=False)
    return _public(problem.settings)


_NAMES: dict[str, Callable[[], Iterable[str]]] = {
    "daqp": _daqp,
    "quadprog": lambda: QUADPROG,
    "piqp": _piqp,
    "proxqp": lambda: PROXQP,
    "osqp": _osqp,
    "clarabel": _clarabel,
}


def check_settings(solver: str, settings: Mapping[str, Any], also: Iterable[str] = ()) -> None:
    """Raise SetupError for a setting that `solver` does not have, or a value that it cannot use.

    also: names that are valid where the settings were given, though not the solver's.
    """
    if not settings:
        return
    library = solver.partition("-")[0]
    valid = [*_NAMES[library](), *also]
    for key in settings:
        if key not in valid:
            raise UnknownNameError(f"setting of the QP solver {solver}", key, valid)
    numpy = require("numpy", "qp", f"the QP solver {solver}")
    P, one = numpy.eye(1), numpy.ones(1)
    if library in SPARSE:
        P = require("scipy.sparse", "qp", f"the QP solver {solver}").csc_matrix(P)
    try:
        solve_qp = require("qpsolvers", "qp", f"the QP solver {solver}").solve_qp
        solve_qp(P, one, None, None, None, None, -one, one, solver=library, **settings)
    except Exception as error:
        given = ", ".join(f"{key} = {value!r}" for key, value in settings.items())
        raise SetupError(f"the QP solver {solver} cannot use {given}: {told(error)}") from None
