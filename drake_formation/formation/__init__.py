"""Formations as geometry and graphs: who stands where, and who is coupled to whom."""
