"""Recordings: what happened, in a file."""
