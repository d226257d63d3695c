"""What a step costs: plain and compiled, one robot and many, ours and the quadratic programs."""
