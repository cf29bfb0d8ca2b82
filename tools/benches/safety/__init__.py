"""`windup bench safety`: end a moving robot in every way there is, and check that it is safe."""
