"""A log compared with what follows from its events. Imported by playback."""
