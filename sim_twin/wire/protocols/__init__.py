"""The servo protocols, on the device's side."""
