"""Changes of a run: starts and kicks that are asked for, the timeline, and the outcomes."""
