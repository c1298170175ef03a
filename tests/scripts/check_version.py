#!/usr/bin/python3
"""Compares the version of CMakeLists.txt, the only argument, with those of CITATION.cff and
of the newest section of CHANGELOG.md."""

import re
import sys
from pathlib import Path

root = Path(__file__).resolve().parent.parent.parent
found = {
    "CITATION.cff": r"^version: (\S+)$",
    "CHANGELOG.md": r"^## (\S+)$",
}
for name, pattern in found.items():
    version = re.search(pattern, (root / name).read_text(), re.MULTILINE)[1]
    if version != sys.argv[1]:
        sys.exit(f"{name}: found {version}, CMakeLists.txt has {sys.argv[1]}")
