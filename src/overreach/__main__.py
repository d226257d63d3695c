"""`python -m overreach` is the command `overreach`."""

from overreach.cli import main

main()
