"""botschool: training robots in simulation by evolution and by reinforcement learning."""

__version__ = "0.1.0"
