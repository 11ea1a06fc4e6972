"""Blocks: one LeafSystem a file, in double, AutoDiffXd and Expression."""
