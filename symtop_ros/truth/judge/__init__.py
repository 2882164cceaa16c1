"""`top_judge`: compare estimates of a filter or a driver with the exact motion.

`truth/fit` uses its reader, its noise and its figures; nothing else imports it.
"""
