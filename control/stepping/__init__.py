"""Steps against pushes: decision, placement, comfort steps, and takeover from a walk."""
