"""Inertial sensors: from their bytes to an `ImuState`."""
