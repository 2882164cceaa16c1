"""`top_judge`: estimates of other programs compared with the exact motion at their stamps."""
