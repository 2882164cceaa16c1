"""top_report: speed against error, measured in one run."""
