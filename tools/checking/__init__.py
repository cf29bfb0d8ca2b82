"""What `windup check` looks at: a robot's folder, file by file."""
