"""python -m botschool"""

import os
import sys

if not getattr(sys.flags, "safe_path", False) and sys.path[:1] == [os.getcwd()]:
    del sys.path[0]  # a folder that the command is called in need not be trusted

from botschool.cli import main

main()
