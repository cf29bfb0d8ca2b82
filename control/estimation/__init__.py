"""From IMU, joints and foot contacts to the state of the base."""
