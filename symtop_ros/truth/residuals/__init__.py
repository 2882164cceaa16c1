"""What an explanation leaves: its noise, what is no noise, and the deviations that follow from it.

Nothing here knows what was explained: the judge and the fit stand on it.
"""
