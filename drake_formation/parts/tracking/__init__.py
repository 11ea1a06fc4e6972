"""Local controllers: each robot on its own reference."""
