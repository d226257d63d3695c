"""The page, and the operator side behind it."""
