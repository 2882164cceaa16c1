"""Runs into MCAP files: the bytes that are published, written by a thread of its own."""
