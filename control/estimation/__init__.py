"""Estimation of the base state from IMU, joints and foot contacts."""
