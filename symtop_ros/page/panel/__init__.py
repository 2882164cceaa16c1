"""`top_panel`: the page as a file, served, or of a running node; only the programs import it."""
