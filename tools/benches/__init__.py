"""`windup bench`: measurements of the stack that anyone can repeat."""
