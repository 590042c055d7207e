"""Limits of a child: output, files, time."""

from botschool.sandbox import process, scratch


def test_output_is_bounded(sandboxed):
    one = sandboxed("def talk():\n    while True: print('x' * 100_000)\n")
    assert one.ask("talk") is None  # not a TimeoutError: it did not go on until its time was over
    assert one.child.ending() == "it printed more than 16 MB"
    assert len(one.child.printed()) < process.OUTPUT_KEPT + 100


def test_written_files_are_bounded(sandboxed, monkeypatch):
    monkeypatch.setattr(scratch, "MAX_WRITTEN_FILES", 50)
    many = sandboxed("def write():\n    for n in range(10**6): open(f'{n}', 'w').close()\n")
    assert many.ask("write") is None
    assert many.child.ending() == "it wrote more than 50 files"
    large = sandboxed("def write():\n    open('x', 'wb').write(b'1' * 70 * 2**20)\n")
    assert large.ask("write")["error"] == "OSError"
