"""What people use instead: other laws on the same Protocol, to be compared with."""
