"""Programs that show how the library is used with others; they are not installed."""
