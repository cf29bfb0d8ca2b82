"""Any command over a grid of its options."""
