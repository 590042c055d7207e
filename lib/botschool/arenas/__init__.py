"""Arenas of wheeled robots: declare them, and step them by hand."""
