"""Declare arenas of wheeled robots, and step them by hand."""
