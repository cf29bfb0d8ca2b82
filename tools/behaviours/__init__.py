"""Behaviours: whatever moves a robot, each with its options, its controller and its report."""
