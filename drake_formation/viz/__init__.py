"""Pictures of runs and of diagrams."""
