"""Random starts of a robot: its initial postures and faults."""
