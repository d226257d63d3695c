"""A robot in a process of its own, which ramps it to zero by itself when the loop's writes stop coming."""
