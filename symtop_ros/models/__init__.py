"""The top as a model file for other engines."""
