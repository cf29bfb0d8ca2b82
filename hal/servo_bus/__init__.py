"""Joints on servo buses: readings, torque, settings and errors of their servos."""
