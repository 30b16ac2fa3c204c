# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the driver for tests in Python."""
import pathlib, subprocess, sys

programs = pathlib.Path(sys.argv[1]).resolve()


def kiln(*words, status=0, folder=None):
    """Runs kiln in a folder and returns the process that has ended; asserts its exit status."""
    ended = subprocess.run([programs / "kiln", *words], capture_output=True, text=True, cwd=folder)
    assert ended.returncode == status, f"{words} ended with {ended.returncode}: {ended.stderr}"
    return ended
