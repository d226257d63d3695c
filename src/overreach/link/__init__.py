"""Between the two halves: commands up, state down, latest wins."""
