"""Sources of the reference: where the formation centre should be."""
