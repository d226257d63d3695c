"""The robot side: one tick, top to bottom, at a fixed rate, in a process of its own."""
