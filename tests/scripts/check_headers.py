#!/usr/bin/env python3
"""Looks whether every scene and study says what it is.

The comment that a file begins with has a text, "Look at", and as its last paragraph
"Run time: about 4 s." (s, min or h, of one process on a core of its own).
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


def flaws(scene):
    header = re.match(r"(#.*\n)*", scene.read_text())[0]
    text = re.sub(r"\s+", " ", re.sub(r"^#", "", header, flags=re.M)).strip()
    if len(text) < 40:
        yield "does not begin with a comment that says what it is"
        return
    if "look at" not in text.lower():
        yield "does not say what to look at"
    if not re.search(r"Run time: about \d+(\.\d+)? (s|min|h)\b[^.]*(\.\d[^.]*)*\.$", text):
        yield "does not end its comment with 'Run time: about ... s.' (min, h)"


def main():
    scenes = [
        path for folder in ("prm", "tests/benchmarks") for path in (ROOT / folder).rglob("*.prm")
    ]
    n_flaws = 0
    for scene in sorted(scenes):
        for flaw in flaws(scene):
            print(f"{scene.relative_to(ROOT)}: {flaw}")
            n_flaws += 1
    return 1 if n_flaws or not scenes else 0


if __name__ == "__main__":
    sys.exit(main())
