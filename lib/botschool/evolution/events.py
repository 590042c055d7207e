"""The run's curves for TensorBoard (`tensorboard --logdir FOLDER`)."""

from __future__ import annotations

import shutil
import time
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from botschool.evolution.record import STAT
from botschool.output import cannot_write

POINTS = 1000
"""TensorBoard shows no more points of a curve than this."""


class Events:
    """Appends generations to an event file, at most about POINTS of them in a whole run."""

    def __init__(self, folder: Path, whole: float) -> None:
        """whole: steps of the whole run, 0 to keep all. What is in the folder is replaced."""
        self._folder = folder
        self._spacing = whole / POINTS
        self._next = 0.0
        self._file: Path | None = None

    def append(self, first: int, rows: np.ndarray, columns: Sequence[str] = STAT) -> None:
        """Generations from number `first`; rows: shape (generations, columns), steps first."""
        from tensorboard.compat.proto.event_pb2 import Event
        from tensorboard.compat.proto.summary_pb2 import Summary
        from tensorboard.summary.writer.record_writer import RecordWriter

        events = [] if self._file else [Event(wall_time=time.time(), file_version="brain.Event:2")]
        for generation, row in enumerate(rows, first + 1):
            if row[0] < self._next:
                continue
            self._next = row[0] + self._spacing
            values = [
                Summary.Value(tag=name, simple_value=value)
                for name, value in zip(columns[1:], row[1:], strict=True)
            ]
            values.append(Summary.Value(tag="generation", simple_value=generation))
            summary = Summary(value=values)
            events.append(Event(wall_time=time.time(), step=int(row[0]), summary=summary))
        try:
            if self._file is None:
                shutil.rmtree(self._folder, ignore_errors=True)
                self._folder.mkdir()
                self._file = self._folder / f"events.out.tfevents.{int(time.time())}"
            with open(self._file, "ab") as file:
                writer = RecordWriter(file)
                for event in events:
                    writer.write(event.SerializeToString())
        except OSError as error:
            raise cannot_write(self._folder, error.strerror or str(error)) from error
