"""Standing, playing pose graphs, getting up, and the first motion after torque enable."""
