"""Step policy networks by hand: the public name of botschool.policies.net."""

from botschool.policies.net import Network, NetworkSpec, PyEvonet

__all__ = ["Network", "NetworkSpec", "PyEvonet"]
