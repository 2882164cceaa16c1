"""Programs of a checkout that measure, retell and load the package; not installed."""
