"""The `windup` command, and `Robot`, which puts a stack together."""
