"""python -m botschool"""

from botschool.cli import main

main()
