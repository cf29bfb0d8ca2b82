"""Input and output of commands: messages, JSON, pictures, progress, ranges of numbers."""
