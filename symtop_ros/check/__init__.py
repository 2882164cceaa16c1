"""What a log says, compared with what follows from its events; for programs that read logs."""
