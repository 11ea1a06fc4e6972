"""Robots: the plants."""
