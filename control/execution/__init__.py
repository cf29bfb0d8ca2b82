"""Execution of planned motions of the CoM and the feet: position servos, whole-body torques."""
