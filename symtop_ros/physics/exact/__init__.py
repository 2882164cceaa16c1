"""The exact motion under gravity: closed form, free motion, and the numbers of 50 digits."""
