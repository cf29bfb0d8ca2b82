"""The motion that an emulated IMU measures, and its faults."""
