"""Transactions on a servo bus: one request, its answers, and what became of it."""
