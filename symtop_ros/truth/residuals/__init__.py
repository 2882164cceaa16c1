"""Analysis of residuals: noise, spectral lines, outliers, and standard deviations.

Nothing here knows what was explained: the judge and the fit stand on it.
"""
