"""`top_judge`: estimates of others compared with the exact motion.

`truth/fit` uses its reader, its noise and its figures; nothing else imports it.
"""
