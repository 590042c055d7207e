"""Read Gradescope's list of submissions."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from botschool.errors import BotschoolError
from botschool.grading.classes.texts import is_larger

NAMES = ("submission_metadata.yml", "submission_metadata.yaml")
_MAX_METADATA, _MAX_VALUES, _DEPTH = 20 * 2**20, 5_000_000, 6


def read_metadata(folder: Path) -> dict[str, dict[str, Any]]:
    """Return Gradescope's data on each submission, all as texts, without the colons of its keys."""
    import yaml

    for name in NAMES:
        path = folder / name
        if path.is_symlink() or not path.is_file() or path.stat().st_size > _MAX_METADATA:
            continue
        try:
            text = path.read_text(encoding="utf-8-sig", errors="replace")
            found = yaml.load(text, yaml.BaseLoader) or {}
        except (yaml.YAMLError, OSError, RecursionError, ValueError, TypeError):
            raise BotschoolError(f"{path} is damaged: download it again.") from None
        if is_larger(found, _MAX_VALUES):
            raise BotschoolError(f"{path} holds too many values: download it again.")
        if not isinstance(found, dict):
            raise BotschoolError(f"{path} does not list submissions: download it again.")
        return {k: v for k, v in _plain_keys(found, 0).items() if isinstance(v, dict)}
    return {}


def _plain_keys(value: Any, depth: int) -> Any:
    if isinstance(value, dict) and depth < _DEPTH:
        return {str(k).lstrip(":"): _plain_keys(v, depth + 1) for k, v in value.items()}
    if isinstance(value, list) and depth < _DEPTH:
        return [_plain_keys(each, depth + 1) for each in value]
    return value
