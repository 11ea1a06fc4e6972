"""When a robot works out its control force."""
