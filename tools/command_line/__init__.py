"""The command line: its table of commands, its parser, its errors."""
