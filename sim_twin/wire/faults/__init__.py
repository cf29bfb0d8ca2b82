"""What goes wrong on emulated buses, as text, as calls, and as it happens."""
