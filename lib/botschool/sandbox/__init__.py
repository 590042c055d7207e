"""Run untrusted Python code in confined child processes and exchange plain data with it.

The package imports nothing of botschool outside itself. README.md states the threat model.
"""

from botschool.sandbox.allowance import Allowance
from botschool.sandbox.errors import Refused, SandboxError
from botschool.sandbox.process import Child, Limits
from botschool.sandbox.scratch import Scratch
from botschool.sandbox.server import ForkServer

__all__ = ["Allowance", "Child", "ForkServer", "Limits", "Refused", "SandboxError", "Scratch"]
