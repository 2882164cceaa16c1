"""The top as a model file for other engines. Imported by session, node, check and judge."""
