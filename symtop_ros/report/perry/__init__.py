"""Perry's map: where hurrying the precession raises the top, over whole ranges of tops."""
