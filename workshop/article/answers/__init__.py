"""Answers to what the article asks or leaves open."""
