"""Limit-cycle balance: step models, the planner of the next step, and the balancer."""
