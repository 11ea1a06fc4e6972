"""Carried objects: springs between the robots, or bodies of their own that the robots hold by grips."""
