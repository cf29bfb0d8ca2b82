"""Limit-cycle balance: step models, the planner that solves for the next step, and the balancer."""
