"""The commands about a runtime: `windup up`, `down` and `status`."""
