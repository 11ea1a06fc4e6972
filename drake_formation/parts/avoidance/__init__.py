"""What robots do about obstacles."""
