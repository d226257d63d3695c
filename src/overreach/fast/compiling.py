"""Python functions of floats -> machine code, with all that they call: the source stays one."""

from __future__ import annotations

from types import BuiltinFunctionType, FunctionType
from typing import Any

from numba import njit

from overreach.fast.mathematics import INSTEAD

_done: dict[Any, Any] = {}


def compiled(function: Any) -> Any:
    """Return `function` compiled, with every function of this package that it calls, and `math` as in `mathematics`.

    The function itself is not changed: its code is compiled with other globals. A division by zero gives inf or nan,
    not an exception; the law never divides by zero (its tests would see the exception).
    """
    if function not in _done:
        names = dict(function.__globals__)
        for name in function.__code__.co_names:
            value = names.get(name)
            if isinstance(value, FunctionType):
                names[name] = compiled(value)
            elif isinstance(value, BuiltinFunctionType):
                names[name] = INSTEAD.get(value, value)
        copy = FunctionType(function.__code__, names, function.__name__, function.__defaults__)
        _done[function] = njit(copy, error_model="numpy", fastmath={"contract"}, forceinline=True)
    return _done[function]
