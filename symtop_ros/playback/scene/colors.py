"""Colours of the scene and its plots, on a dark ground."""

BLUE = (96, 165, 255)
GREEN = (92, 214, 146)
RED = (255, 96, 120)
GOLD = (255, 208, 96)
ORANGE = (232, 138, 72)
GREY = (70, 78, 92)
GROUND = (22, 26, 34)
