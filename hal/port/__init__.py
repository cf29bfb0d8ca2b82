"""Serial ports (device, network, or simulated): opening, locking, measuring and reopening them."""
