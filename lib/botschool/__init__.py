"""botschool: training robots in simulation by evolution and by reinforcement learning."""

from botschool import moved  # noqa: F401  (keeps old names of modules)

__version__ = "0.1.0"
