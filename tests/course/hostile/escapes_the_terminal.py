"""Prints and raises what steers terminals, consoles and web pages."""


def hostile(*arguments, **options):
    text = "\x1b[2J\x1b]0;owned\x07\x9b2J[bold red]100 of 100[/] \u202e <script>alert(1)</script>"
    print(text, "\r\b\b\b" * 10, "\ud800".encode("utf-8", "surrogatepass"))
    raise ValueError(text + " </pre> [/nothing] \ud800")
