"""Content of pages, live or saved to a file: the run, its 3D scene, its facts, the markup."""
