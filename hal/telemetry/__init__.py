"""What a run publishes in shared memory for everybody else."""
