"""The top in Rerun: what is drawn, where it comes from, and how it is laid out."""
