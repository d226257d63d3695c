"""How one EE velocity is shared between base and arm: pure functions of floats."""
