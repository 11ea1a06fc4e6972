"""How a robot knows its own state."""
