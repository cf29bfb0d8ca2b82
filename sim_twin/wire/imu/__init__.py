"""What an emulated IMU feels, and how it fails."""
