"""Starts and kicks that are asked for, the timeline, and the outcomes. For all above."""
