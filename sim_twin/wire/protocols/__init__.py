"""Protocols as an emulated device speaks them."""
