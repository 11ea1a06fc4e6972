"""The paper, reproduced: its tables, figures and claims from this project's own diagrams."""
