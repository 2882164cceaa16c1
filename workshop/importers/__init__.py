"""Which importer reads which description of a body: what `make -C workshop importers` runs."""
