"""Records of tops that share no line and no assumption with the fit, which they try."""
