"""The guardian: a process beside every armed robot that stops it when its program dies or hangs."""
