"""Records of tops that share no line and no assumption with the fit, to try what the fit assumes."""
