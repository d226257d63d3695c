"""Arms of any joints in space: screws, task rows, inverse, limits, one step. Written twice: scalar, and with numpy."""
