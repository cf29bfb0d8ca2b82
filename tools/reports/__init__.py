"""Reports of runs: numbers, arrays, files and pictures."""
