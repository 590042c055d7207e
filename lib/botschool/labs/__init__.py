"""Laboratories: experiments of the student's own, checked by doing them again."""
