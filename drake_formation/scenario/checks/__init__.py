"""What must hold between several fields of a scenario, checked before Drake sees it."""
