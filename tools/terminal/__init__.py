"""What people read and programs write: output, pictures, progress, numbers that are checked."""
