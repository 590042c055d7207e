"""Tests open no window: pygame and matplotlib draw in memory."""

import os

os.environ["SDL_VIDEODRIVER"] = "dummy"
os.environ["MPLBACKEND"] = "Agg"
