"""What configuration is made of: strict sections and values, one value for all or one for each, and faults in words."""
