"""How an episode ended: answers that mix up `terminated` and `truncated`."""

from __future__ import annotations

from typing import Any

from botschool.grading.declare.checks import Wrong, show

ENDS = ("terminated", "truncated")


def expect_ends(said: str, got: tuple[Any, Any], wanted: tuple[bool, bool], why: str) -> None:
    """`terminated` and `truncated` are as wanted, truth values; `said` names the call.

    why: what stands before the right value, as "the environment said".
    """
    for name, value, right in zip(ENDS, got, wanted, strict=True):
        if not isinstance(value, bool) or value != right:
            sentence = f"{said}: {name} is {show(value)}, but {why} {right}."
            raise Wrong(f"{sentence}\n  {mixed_up(got, wanted)}".rstrip())


def mixed_up(got: tuple[Any, Any], wanted: tuple[bool, bool]) -> str:
    """A sentence about what was taken for what; "" if it is none of the usual mistakes."""
    got = tuple(got)
    if got == wanted or not all(isinstance(each, bool) for each in got):
        return ""
    if got == wanted[::-1]:
        return (
            "The two are exchanged: an episode is terminated when the problem itself has ended, "
            "and truncated when only its time is over."
        )
    if got == (True, True):
        rest = {
            (True, False): ": what ended by itself is not truncated.",
            (False, True): ": when only the time is over, terminated stays False.",
        }
        return f"Both are True, as the old `done` was{rest.get(wanted, '.')}"
    if got == (False, True) and wanted == (False, False):
        return (
            "truncated tells that the environment's own time limit is over; who stops earlier, "
            "after as many steps as were asked for, truncates nothing."
        )
    return ""


def went_on(terminated: bool, truncated: bool) -> str:
    """A sentence for an answer that goes on after this end of an episode; "" if it was none."""
    if terminated == truncated:
        return ""
    one, other = ENDS if terminated else ENDS[::-1]
    return f"It was {one} there, not {other}: an episode is over when either of the two is True."
