"""Data sheets of servos: one table a family, one line a servo."""

from windup.hal.servos.catalogue import servo_model, servo_names

__all__ = ["servo_model", "servo_names"]
