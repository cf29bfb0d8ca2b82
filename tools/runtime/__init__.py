"""One process owns a robot: the runtime, its socket, and its clients."""
