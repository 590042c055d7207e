"""Make the pages, figures and data that come from long runs.

    python tools/studies                 lists the studies
    python tools/studies NAME ARGS       runs one; the head of NAME.py describes its arguments

What was measured is kept in data/, so a page is made anew without a run. Benchmarks are in
tests/bench.
"""

import ast
import importlib
import sys
from pathlib import Path

HERE = Path(__file__).parent
TESTS = HERE.parents[1] / "tests"


def studies() -> dict[str, str]:
    """Return the name of each study and the first line of its description."""
    trees = {path.stem: ast.parse(path.read_text()) for path in sorted(HERE.glob("[a-z]*.py"))}
    return {
        name: (ast.get_docstring(tree) or "").partition("\n")[0]
        for name, tree in trees.items()
        if any(isinstance(node, ast.FunctionDef) and node.name == "main" for node in tree.body)
    }


def main() -> int:
    found = studies()
    if len(sys.argv) < 2 or sys.argv[1] not in found:
        print("Choose a study: python tools/studies NAME ARGS\n")
        print("\n".join(f"  {name:18}{line}" for name, line in found.items()))
        return 2
    sys.path += [str(TESTS / "bench"), str(TESTS)]
    return importlib.import_module(sys.argv.pop(1)).main() or 0


if __name__ == "__main__":
    sys.exit(main())
