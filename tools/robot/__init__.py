"""`Robot`: a stack of backend, guard, estimator and loop, and its runs."""
