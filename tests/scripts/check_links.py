#!/usr/bin/env python3
"""Looks for what README.md, doc/ and the headers of the scenes name and is not there.

usage: tests/scripts/check_links.py [FILE...]

  links       [text](target), pictures and anchors, relative to the page
  code spans  `files` and folders, `Classes`, `function_names`, `Section/Entry`
  entries     of a page whose scene is built in steps in prm/, which have to have them
  commands    in ```sh blocks and code spans: programs, options, scenes, entries of
              --set and presets; $variables of loops take all their values

Prints a line for each thing that is missing; the exit code is 1 if there is any.
What a page names in capitals (FILE.prm), in <brackets> or with an ellipsis stands for
something else and is left out, as is what a run leaves (output/).
"""

import fnmatch
import functools
import itertools
import json
import re
import shlex
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
# What a page may name and nobody has in a clone: of builds, runs, and the reader's own.
MADE = ("output", "build", "checkpoint", "bin", "share", "parameters.prm", "strip.prm")
ENDINGS = (".h", ".cc", ".py", ".prm", ".md", ".cmake", ".sh", ".sbatch", ".msh")
PROGRAMS = set(
    "cd chromium cmake cp cpack ctest echo export git grep kill ls make module mpirun mkdir mv"
    " paraview pvpython rm sbatch scancel scontrol spack squeue srun tail time xvfb-run"
.split()
)
KEYWORDS = {"do", "done", "then", "else", "fi", "if", "while", "!", "{", "}"}


@functools.cache
def files():
    """All files of the project and the folders that they stand in."""
    found = {
        path.relative_to(ROOT).as_posix()
        for path in ROOT.rglob("*")
        if path.is_file()
        and path.relative_to(ROOT).parts[0] not in (".git", "build", "output")
    }
    return found | {str(parent) for file in found for parent in Path(file).parents}


@functools.cache
def text_of_code():
    endings = {".h", ".cc", ".in", ".py", ".prm", ".cmake", ".txt", ".json", ".sh", ""}
    return "\n".join(
        (ROOT / file).read_text(errors="ignore")
        for file in sorted(files())
        if (ROOT / file).is_file()
        and not file.startswith("doc/")
        and Path(file).suffix in endings
    )


@functools.cache
def names():
    """Every name that the code has, and those of files."""
    return set(re.findall(r"[A-Za-z_]\w*", text_of_code())) | {
        Path(file).stem for file in files()
    }


@functools.cache
def literals():
    """Every string of the program: sections and entries are among them."""
    return set(
        itertools.chain.from_iterable(
            re.findall(r'"((?:[^"\\\n]|\\.)*)"', (ROOT / file).read_text())
            for file in files()
            if file.startswith(("source/", "include/")) and file.endswith((".h", ".cc"))
        )
    )


@functools.cache
def endings_of_names():
    return tuple(literal for literal in literals() if re.match(r"_[a-z]{2}", literal))


@functools.cache
def text_of(file):
    return (ROOT / file).read_text()


def is_open(word):
    """Whether a word stands for something that the reader puts in."""
    return bool(re.search(r"<|\.\.\.|\$", word)) or Path(word).stem.isupper()


def exists(path):
    """Whether a file or folder ends so, or like this pattern."""
    path = path.rstrip("/")
    return path in files() or any(
        fnmatch.filter(files(), pattern) for pattern in (path, "*/" + path)
    )


def check_entry(entry):
    """An entry of the parameter file, as --set has it."""
    name = entry.partition("=")[0].strip().rsplit("/")[-1]
    if not is_open(name) and name not in literals():
        yield f"no entry '{name}'"


def check_command(words, loops):
    """One command with its arguments."""
    while words and (words[0] in KEYWORDS or re.fullmatch(r"\w+=.*", words[0])):
        words = words[1:]
    if not words:
        return
    if words[0] == "for":
        loops[words[1]] = words[3:]
        return
    if words[0] in ("nice", "timeout", "mpirun", "srun", "env", "bash", "nohup"):
        while words and not re.search(r"/|\.prm$|^(ctest|cmake|impm_dealii)$", words[0]):
            words = words[1:]
        if not words:
            return
    program, *arguments = words
    source = ""
    if program.endswith(("/impm_dealii", "impm_dealii")):
        source = "source/app/command_line.cc"
    elif program.endswith(".prm"):
        source = "source/app/command_line.cc"
        arguments = words
    elif program in files() and (ROOT / program).is_file():
        source = program
    elif program.startswith("build/") and Path(program).name in names():
        pass
    elif program not in PROGRAMS and not is_open(program):
        yield f"no program '{program}'"
        return
    if program in ("cmake", "ctest") and "--preset" in arguments:
        preset = arguments[arguments.index("--preset") + 1]
        presets = json.loads(text_of("CMakePresets.json"))
        if preset not in [p["name"] for p in presets["configurePresets"]]:
            yield f"no preset '{preset}'"
    before = ""
    for word in arguments:
        variables = [v for v in loops if re.search(rf"\$({v}\b|{{{v}}})", word)]
        for values in itertools.product(*(loops[v] for v in variables)):
            filled = word
            for variable, value in zip(variables, values):
                filled = re.sub(rf"\$({variable}\b|{{{variable}}})", value, filled)
            if before == "--set" and source:
                yield from check_entry(filled)
            elif filled.startswith("--") and source:
                option = re.escape(filled.partition("=")[0])
                if not re.search(option + r"(?![\w-])", text_of(source)):
                    yield f"{program} has no option '{filled}'"
            elif (
                re.match(r"(prm|doc|contrib|tests|source)/", filled)
                or filled.endswith(".prm")
            ) and not is_open(filled):
                # The reader's own scenes stand anywhere, and scripts draw pictures.
                is_made = source.startswith("contrib/") and filled.startswith("doc/")
                if "/" in filled and not exists(filled + "*" * is_made):
                    yield f"no file '{filled}'"
        before = word


def commands(text):
    """The commands of a piece of shell, as lists of words."""
    for line in text.replace("\\\n", " ").splitlines():
        lexer = shlex.shlex(line, posix=True, punctuation_chars=";&|<>")
        lexer.whitespace_split = True
        command = []
        for word in lexer:
            if re.fullmatch(r"[;&|]+", word):
                yield command
                command = []
            elif word != "\n":
                command.append(word)
        yield command


def check_shell(text):
    loops = {}
    for command in commands(text):
        yield from check_command(command, loops)


def check_span(span):
    """What stands between two `."""
    if re.match(r"(\S*/)?impm_dealii |contrib/\S+ |mpirun |cmake |\S+\.prm --", span):
        yield from check_shell(span)
    elif re.fullmatch(r"[\w.*/-]+", span) and (
        re.fullmatch(r"[^/].*/", span) or (span.endswith(ENDINGS) and not span.startswith("."))
        or re.match(r"(prm|doc|contrib|tests|source|include)/", span)
    ):
        if span.split("/")[0] not in MADE and not is_open(span):
            if not exists(span):
                yield f"no file '{span}'"
    elif re.fullmatch(r"[A-Z][\w' -]*(/[\w' -]+)+( ?=.*)?", span):
        yield from check_entry(span)
    elif match := re.fullmatch(r"([A-Z][a-z'-]+(?: [a-z'-]+)+)( ?= ?.*)?", span):
        if match[1] not in literals():
            yield f"no entry '{match[1]}'"
    elif re.fullmatch(r"[A-Za-z_]\w*((::|\.)\w+)*(\.?\*)?(<.*>)?(\(.*\))?", span):
        for name in re.split(r"::|\.", re.sub(r"[<(].*", "", span)):
            # Not of one letter, nor with an index behind, which stand in formulas.
            name = re.sub(r"_[a-z]$", "", name)
            is_name = re.search(r"[a-z][A-Z]|[a-z]{2}_[a-z]{2}|\*$", name)
            if name.endswith("*"):
                if name != "*" and not any(n.startswith(name[:-1]) for n in names()):
                    yield f"no name '{span}'"
                continue
            # The code makes some of them, with endings and numbers.
            bare = re.sub(r"\d+$", "", name)
            is_made = any(bare.endswith(ending) for ending in endings_of_names())
            if is_name and not is_made and not {name, bare} & (names() | literals()):
                yield f"no name '{name}'"


@functools.cache
def anchors(page):
    """What GitHub calls the headings of a page."""
    found = set()
    for line in strip_blocks(page.read_text()).splitlines():
        if match := re.match(r"#+ +(.*?)\s*$", line):
            title = re.sub(r"\[([^]]*)\]\([^)]*\)", r"\1", match[1])
            slug = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
            number = next(
                n for n in itertools.count() if f"{slug}-{n}".removesuffix("-0") not in found
            )
            found.add(f"{slug}-{number}".removesuffix("-0"))
    return found


def strip_blocks(text):
    """Without what stands in fences, with as many lines."""
    return re.sub(
        r"^ *```.*?^ *```", lambda m: "\n" * m[0].count("\n"), text, flags=re.S | re.M
    )


def check_link(page, target):
    if re.match(r"[a-z]+:", target):
        return
    path, _, anchor = target.partition("#")
    file = (page.parent / path).resolve() if path else page
    if not file.exists():
        yield f"no file '{target}'"
    elif anchor and file.suffix == ".md" and anchor not in anchors(file):
        yield f"no heading '#{anchor}' in {file.name}"


def check_page(page):
    """Pairs of a line and what is wrong there."""
    text = page.read_text()
    for block in re.finditer(r"^ *```sh\n(.*?)^ *```", text, flags=re.S | re.M):
        for flaw in check_shell(block[1]):
            yield text.count("\n", 0, block.start()) + 1, flaw
    folder = ROOT / "prm" / page.stem
    scenes = []
    if (folder / "step_1.prm").exists():
        scenes = [path.read_text() for path in folder.rglob("*.prm")]
    for block in re.finditer(r"^```\n(subsection .*?)^```", text, flags=re.S | re.M):
        if scenes and not any(block[1] in scene for scene in scenes):
            yield (
                text.count("\n", 0, block.start()) + 1,
                f"these entries stand in no file of prm/{page.stem}/",
            )
    prose = strip_blocks(text)
    for pattern, check in (
        (r"\]\(([^)\s]+)\)", functools.partial(check_link, page)),
        (r'<img [^>]*src="([^"]+)"', functools.partial(check_link, page)),
        (r"`([^`]+)`", check_span),
    ):
        for match in re.finditer(pattern, prose):
            word = re.sub(r"\s+", " ", match[1])
            for flaw in check(word):
                yield prose.count("\n", 0, match.start()) + 1, flaw


def check_scene(scene):
    """What the header of a scene names."""
    header = ""
    for line in scene.read_text().splitlines():
        if not line.startswith("#"):
            break
        header += line[1:] + "\n"
    for match in re.finditer(r"(?<![\w/])[\w/*-]+/[\w*/-]+\.\w+|\b\w+\.(prm|py)\b", header):
        if match[0].endswith(ENDINGS) and not exists(match[0]):
            yield header.count("\n", 0, match.start()) + 1, f"no file '{match[0]}'"
    for match in re.finditer(r'--set\s+("[^"]+"|\S+)', header):
        for flaw in check_entry(match[1].strip('"')):
            yield header.count("\n", 0, match.start()) + 1, flaw


def main(*arguments):
    pages = [Path(a).resolve() for a in arguments] or [
        ROOT / "README.md",
        *sorted((ROOT / "doc").glob("*.md")), # Sphinx looks at those of the site
        *sorted((ROOT / "prm").rglob("*.prm")),
    ]
    n_flaws = 0
    for page in pages:
        check = check_scene if page.suffix == ".prm" else check_page
        for line, flaw in sorted(set(check(page))):
            print(f"{page.relative_to(ROOT)}:{line}: {flaw}")
            n_flaws += 1
    return 1 if n_flaws else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
