"""Prints lines for people. The import of rich is deferred to the first one."""


def say(text: str) -> None:
    """Print a line on standard error, unchanged: without markup, and not broken into lines."""
    from windup.tools.terminal.output import console

    console.print(text, markup=False, soft_wrap=True)
