"""Random broken robots and odd command lines, all of which must end with a proper message."""
