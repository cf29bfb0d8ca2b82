"""Directed steps: footprints, the swing to them, and the limbs that follow."""
