"""Make the pages, figures and data that come from long runs.

    python tools/studies                 lists the studies
    python tools/studies NAME ARGS       runs one; the head of NAME.py describes its arguments
    python tools/studies pages [NAME]    writes all pages, or those of NAME

What was measured is kept in data/, so a page is made anew without a run. Benchmarks are in
tests/bench.
"""

import ast
import importlib
import sys
from pathlib import Path

HERE = Path(__file__).parent
TESTS = HERE.parents[1] / "tests"


def studies(function: str) -> dict[str, str]:
    """Return the modules that have this function, and the first line of their description."""
    trees = {path.stem: ast.parse(path.read_text()) for path in sorted(HERE.glob("[a-z]*.py"))}
    return {
        name: (ast.get_docstring(tree) or "").partition("\n")[0]
        for name, tree in trees.items()
        if any(isinstance(node, ast.FunctionDef) and node.name == function for node in tree.body)
    }


def main() -> int:
    """See the top of the file."""
    name, *others = sys.argv[1:] or [""]
    sys.path += [str(TESTS / "bench"), str(TESTS)]
    if name in studies("main"):
        return importlib.import_module(sys.argv.pop(1)).main() or 0
    writers = {module.removesuffix("_page"): module for module in studies("pages")}
    if name == "pages" and set(others) <= set(writers):
        for each in others or writers:
            for page in importlib.import_module(writers[each]).pages():
                page.write()
        return 0
    print("Choose a study: python tools/studies NAME ARGS\n")
    print("\n".join(f"  {name:18}{line}" for name, line in studies("main").items()))
    print(f"\nor: python tools/studies pages [{' | '.join(writers)}]")
    return 2


if __name__ == "__main__":
    sys.exit(main())
