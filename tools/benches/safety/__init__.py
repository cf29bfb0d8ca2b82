"""`windup bench safety`: end a moving robot in every way there is, and see who switches it off."""
