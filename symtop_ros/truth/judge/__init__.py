"""`top_judge`: estimates of others compared with the exact motion. Nothing imports it."""
