"""Controllers: observations in, joint commands out."""
