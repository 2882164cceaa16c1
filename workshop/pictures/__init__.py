"""The pictures of the documents, made without a screen."""
