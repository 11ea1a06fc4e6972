"""Where the formation centre should be."""
