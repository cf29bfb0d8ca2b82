"""The quantities that are regulated from step to step, and the record of each step."""
