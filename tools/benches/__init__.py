"""`windup bench`: what is measured of the stack, by anybody."""
