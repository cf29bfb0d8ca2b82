"""Steps that save a robot from a push, and who decides on them."""
