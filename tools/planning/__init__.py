"""Planning of steps in a process beside the loop."""
