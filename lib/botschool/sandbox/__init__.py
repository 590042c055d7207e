"""Runs untrusted Python code in confined child processes and exchanges plain data with it.

Imports nothing of botschool outside this package. README.md states the threat model.
"""

from botschool.sandbox.allowance import Allowance
from botschool.sandbox.errors import Refused, SandboxError
from botschool.sandbox.process import Child, Limits
from botschool.sandbox.scratch import Scratch
from botschool.sandbox.server import ForkServer

__all__ = ["Allowance", "Child", "ForkServer", "Limits", "Refused", "SandboxError", "Scratch"]
