"""Engines to read and to compare with: the exact one in plain Python, and the paper's ticks."""
