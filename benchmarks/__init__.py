"""Numbers that a promise was made about. Run all with `make bench`, or one with `python -m benchmarks NAME`."""
