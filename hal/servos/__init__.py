"""Data sheets of servos: one table per family, one entry per servo model."""

from windup.hal.servos.catalogue import servo_model, servo_names

__all__ = ["servo_model", "servo_names"]
