"""Seventy motions of heavy tops to 30 digits, packed, and their scorer. For judge."""
