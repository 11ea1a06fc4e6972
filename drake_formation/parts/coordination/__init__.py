"""What robots do with what they hear from each other."""
