"""Servo bus: register access, sync reads and writes, and the settings of servos."""
