"""Takes all the memory that there is."""


def hostile(*arguments, **options):
    blocks = []
    while True:
        try:
            blocks.append(bytearray(64 * 2**20))
        except MemoryError:
            blocks.append(b"1" * 1000)
