"""python -m botschool"""

import os
import sys

if not getattr(sys.flags, "safe_path", False) and sys.path[:1] == [os.getcwd()]:
    del sys.path[0]  # the current folder may hold untrusted modules

from botschool.cli import main

main()
