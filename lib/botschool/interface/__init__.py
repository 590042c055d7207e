"""The interface for programs: what `import botschool` offers (docs/python.md)."""
