"""What a run leaves behind: numbers, arrays, files, pictures."""
