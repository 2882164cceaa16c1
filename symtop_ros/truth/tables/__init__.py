"""Tables of text, for each program that reads one: names, units, times, and what was left out."""
