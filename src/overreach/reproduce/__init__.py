"""`overreach reproduce`: the paper's figures, what it does not show, and how it compares: one page."""
