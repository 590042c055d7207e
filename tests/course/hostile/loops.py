"""Never comes back."""


def hostile(*arguments, **options):
    while True:
        pass
