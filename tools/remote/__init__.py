"""Clients of a robot that is up: messages, a connection, commands with --up, `Robot.connect`."""
