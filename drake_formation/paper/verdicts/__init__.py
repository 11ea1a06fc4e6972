"""What became of the paper's claims, each with the number that decides it."""
