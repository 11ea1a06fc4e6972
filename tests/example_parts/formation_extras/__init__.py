"""Parts that another package brings."""
